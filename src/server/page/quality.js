// The quality of quick pictures: functions that choose the number of pixels and the distance of the sheets such that the picture has a given
// work. The work of a picture is its number of pixels divided by the distance of its sheets in voxels, since a picture's time grows with its
// pixels times its sheets.
//
// Of all pictures of one work, the one whose sheets are as far apart as its pixels are long is nearest to the exact picture: wider sheets
// need coarser volumes, which lose thin parts, and closer sheets need pixels that are longer than voxels
// (docs/laboratory/frames.md has the figures). Pixels and sheets that are a voxel apart lose nothing.

const LEAST_PIXELS = 160 * 100; // least size of a picture, if the full picture has more
// The most voxels between sheets: the coarsest volumes have voxels of this length.
const WIDEST = 8;
// The preview takes the coarsest volume whose voxels are at most this times as long as its sheets are apart (halflight/preview.h).
const LONGEST_VOXEL = Math.SQRT2;
// A picture of volumes that are a step finer takes up to 2.1 times as long as another of the same work. Finer volumes are therefore taken only
// if there is time for 2.5 times the work; the work goes with the third power of the distance of sheets. Without this reserve, pictures would
// alternate between finer and coarser volumes.
const FINER_AFTER = Math.cbrt(2.5);

const least = (pixels) => Math.min(LEAST_PIXELS, pixels);
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// Returns the length, in voxels of the full volume, of the voxels that the preview takes for sheets
// this far apart.
const voxelFor = (spacing) => 2 ** Math.floor(Math.log2(clamp(LONGEST_VOXEL * spacing, 1, WIDEST)));

// Returns the least work of a quick picture, given the number of pixels of the full picture.
export const leastWork = (pixels) => least(pixels) / WIDEST;

// full: { pixels, voxels }: the number of pixels of the full picture, and the length of such a pixel at the target in voxels.

// Returns the work of a picture whose sheets, and whose pixels, are `spacing` voxels apart.
export const workAt = (spacing, { pixels, voxels }) => clamp(pixels * (voxels / spacing) ** 2, least(pixels), pixels) / spacing;

// Returns { pixels, spacing } of the picture that has this work.
export function fit(work, full) {
  // `single` is the number of pixels of a picture whose pixels are a voxel long. A picture with more pixels has sheets one voxel apart. A picture with
  // fewer pixels has pixels that are sqrt(single / pixels) voxels long, and sheets that are as far apart as its pixels are long. The work of the
  // picture with fewer pixels is pixels ** 1.5 / sqrt(single).
  const single = full.pixels * full.voxels ** 2, pixels = clamp(work >= single ? work : Math.cbrt(work ** 2 * single), least(full.pixels), full.pixels);
  return { pixels, spacing: clamp(Math.max(pixels / work, Math.sqrt(single / pixels)), 1, WIDEST) };
}

// Does what fit() does, for pictures that follow each other. voxel: the length of the last picture's voxels. Returns { pixels,
// spacing, voxel }.
export function follow(work, full, voxel) {
  const wanted = fit(work, full), wantedVoxel = voxelFor(wanted.spacing);
  if (wantedVoxel >= voxel || FINER_AFTER * wanted.spacing * LONGEST_VOXEL <= voxel) return { ...wanted, voxel: wantedVoxel };
  const spacing = (1.001 * voxel) / LONGEST_VOXEL; // the closest sheets of these voxels
  return { pixels: clamp(work * spacing, wanted.pixels, full.pixels), spacing, voxel };
}
