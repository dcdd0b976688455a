/* volume/formats/formats.h - registers the readers of formats, in the order in which hl_volume_load asks
 * them.
 *
 * Each NAME stands for a reader, a file NAME.c that defines hl_format_NAME (see format.h). meson.build reads
 * the names from this file. */
/* clang-format off */
#define HL_FORMATS     \
  HL_FORMAT(raw)       \
  HL_FORMAT(nrrd)      \
  HL_FORMAT(metaimage) \
  HL_FORMAT(vgi)       \
  HL_FORMAT(slc)       \
  HL_FORMAT(nifti)     \
  HL_FORMAT(mgh)       \
  HL_FORMAT(vtu)       \
  HL_FORMAT(vtp)       \
  HL_FORMAT(vthb)      \
  HL_FORMAT(vti)       \
  HL_FORMAT(legacy_vtk) \
  HL_FORMAT(npy)       \
  HL_FORMAT(tiff)      \
  HL_FORMAT(mrc)       \
  HL_FORMAT(nanovdb)   \
  HL_FORMAT(openvdb)   \
  HL_FORMAT(amrex)     \
  HL_FORMAT(zarr)      \
  HL_FORMAT(dicom)     \
  HL_FORMAT(slices)    \
  HL_FORMAT(lammps)    \
  HL_FORMAT(particle_table) \
  HL_FORMAT(xyz)       \
  HL_FORMAT(dat)
