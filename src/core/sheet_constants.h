/* core/sheet_constants.h - defines constants of the loop over sheets. The functions of the sheet loop for
 * processors and the kernels for devices include this file, so that processors and devices compute light by
 * the same law.
 *
 * The text is valid C17, OpenCL C 1.2 and CUDA C++: the file consists of comments and macros only. The
 * comment of a macro says where its number is used, and why the number has its value. */
#ifndef HL_CORE_SHEET_CONSTANTS_H
#define HL_CORE_SHEET_CONSTANTS_H

/* ---- the grid ---- */

/* A grid also has values outside of its box, up to GRID_MARGIN voxels away, because slabs that cross the
 * box's faces need these values. */
#define GRID_MARGIN 4

/* The distance behind a face, in voxels, beyond which the face does not affect how matter is lit. Matter
 * nearer to the face is partly lit as a surface at the face. */
#define FACE_VOXELS 2.0f

/* ---- the sheets ---- */

/* The greatest number of sheets of a sweep; a sweep of more sheets is refused. A cube of 14,000 voxels a side
 * has GREATEST_SHEETS sheets if the sheets are a quarter of a voxel apart. With GREATEST_SHEETS sheets, a
 * picture of 32 x 32 pixels takes about ten seconds, and the rounding of a sheet's height to a float is a
 * hundredth of the distance of sheets. */
#define GREATEST_SHEETS 100000

/* ---- the weights of voxels ---- */

/* Weights along x of u8 and u16 voxels are integers, so that the weighted sum of four taps is exact on every
 * instruction set. The sum is at most 255 * 32766 for u8, which a float holds exactly, and 65535 * 32766 for
 * u16, which 32 bits hold. A weight is never negative and fits a signed 16-bit number. A slope is the
 * derivative of a weight. A slope fits a signed 16-bit number, too: the slopes of all kernels, and the sums
 * of slopes, are below 1.08 in magnitude. */
#define WEIGHT_UNITS 32766
#define SLOPE_UNITS  30000

/* ---- classification ---- */

/* If two coordinates of a classifier's table are closer than this number of entries, the mean of the table
 * between the coordinates is computed as the mean of the two values there. A difference of integrals would
 * lose digits for such coordinates, and the mean of two values is accurate enough. */
#define CLOSE_ENTRIES 4.0f

/* The least bending of a way through the table for which the colour is computed as a mean over the way. The
 * bending is the change of a colour's slope along the way, times the way's length in entries. If a way bends
 * less, the colour at the mean entry is used. The colour at the mean entry differs from the mean colour by at
 * most a quarter of the bending, 1/1024 (derived: the difference is greatest for a single bend in the middle,
 * with half of the weight at each end). */
#define CLASSIFIER_LEAST_BENDING (1.0f / 256)

/* The colour of a slab comes from differences of the integral T at two coordinates, T(f2) - T(f1).
 * LEAST_PART_OF_SHOWN is the least difference of two values of T that is used, as a fraction of T. A smaller
 * difference of two floats has too few exact digits. */
#define LEAST_PART_OF_SHOWN (1.0f / 4096)

/* ---- the picture ---- */

/* The optical depth below which the gradient has hardly any effect on the light that a slab absorbs. */
#define THIN_DEPTH (1.0f / 64)

/* The alpha from which on a pixel counts as opaque. Matter behind an opaque pixel would change the pixel by
 * less than half a step of 10 bits. */
#define PIXEL_OPAQUE (1.0f - 1.0f / 2048)

/* ---- the shadow buffer ---- */

/* The transmittance below which a pixel of the shadow buffer counts as dark: a quarter of a step of 8
 * bits. */
#define DARK (1.0f / 1024)

/* The transmittance at the start of a chunk of slabs below which a surface in the chunk counts as being in
 * the dark (shadow/attenuate.h, "Marks of surfaces in the dark"). */
#define DARK_AT_START (1.0f / 256)

/* OUTWARDS_POWER sets how soon a surface ends for light that leaves the surface again (shadow/attenuate.h).
 * When the depth h has fallen by a tenth, the fraction .19 of the absorbed light still lights the surface.
 * When h has fallen by a third, only the fraction .0015 of the absorbed light does. */
#define OUTWARDS_POWER 16

/* The number of voxels of even matter over which the kept light k falls by the factor e. Matter that is even
 * over a voxel is no edge of a surface. Therefore light that a wall has absorbed does not light a floor
 * behind even matter a second time. At the faces of cuts, behind which matter is often even, the skin is used
 * in addition. */
#define EVEN_VOXELS 1

/* A slab's end, times this factor, is a height just beyond the end: one or two steps of a float further. A
 * ray that no cut ends leaves the slab at the height just beyond the slab's end, which distinguishes the ray
 * from a ray that ends at the slab's end.
 */
#define BEYOND_SLAB 1.00000012f

/* Light may come from the matter of one surface into another surface, which begins at the value `foot`. In a
 * blurred edge, values rise through the values of the first surface to the values of the second. In a blurred
 * edge the two surfaces are one surface, and the light that the first surface has absorbed lights the second
 * surface, too. The optical depth of the first surface on the light's way is compared with the depth of a
 * straight ramp of values. If the first surface has at most SAME_RAMP times the depth of the ramp, the two
 * surfaces are a blurred edge. From OTHER_LAYER times the depth of the ramp on, the first surface is a layer
 * of its own, and the light that it has absorbed does not light the second surface. */
#define SAME_RAMP   1.2f
#define OTHER_LAYER 1.6f

/* ---- the matter between a face of a box and the slab ---- */

/* The number of pixels of the shadow buffer that lie around a position. A look-up between pixels uses the
 * four near pixels.
 */
#define NEAR_PIXELS 4

/* A limit for faces that are nearly parallel to the light. The distance to a face that is nearly parallel to
 * the light changes much from one near pixel to the next. The face counts fully while the change of the
 * distance is below ALONG_FACE times the length of the light's way through the box. From twice the value
 * ALONG_FACE on, the face does not count, because light on both sides of the face enters the box through
 * another face, far away. */
#define ALONG_FACE 0.5f

/* The greatest optical depth that is used. Behind the depth DEEPEST hardly any light is left, but exp(-depth)
 * is still above 0 as a float. */
#define DEEPEST 80.0f

/* Each near pixel has an optical depth, from the face to the slab. If the near pixels' depths differ by less
 * than EVEN_LIGHT, the buffer is read as if there were no face. If the depths differ by at least twice
 * EVEN_LIGHT, the face counts fully. */
#define EVEN_LIGHT 0.1f

/* ---- the cascade ---- */

/* Blurred sums leave a little light in umbrae, which should be dark. Therefore a transmittance below UMBRA is
 * set to 0. */
#define UMBRA (1.0f / 160)

/* Matter counts as thin if it absorbs less than THIN_MATTER of the light in a chunk, and as solid if it
 * absorbs more than SOLID_MATTER. */
#define THIN_MATTER  0.25f
#define SOLID_MATTER 0.75f

/* ---- sub-lights ---- */

/* A sub-light is one of the points that stand for a light. SUBLIGHT_ONE is full light in a pixel of a
 * sub-light's buffer, which is a number of 16 bits. */
#define SUBLIGHT_ONE 65535

/* The greatest number of taps by which sixteen pixels in a row of a sub-light read a row of a slab's
 * copies. */
#define SUBLIGHT_TAPS 8

/* The least fraction of light that a slab absorbs for which the kept light k (shadow/attenuate.h) is found
 * from the slab's two transmittances. For a smaller fraction, k would be lost in rounding errors. */
#define LEAST_ABSORBED 1e-5f

/* The number of pixels around a block of the slab that count as part of the block. A value at a half pixel
 * depends on two pixels on either side, so the block's values affect a sub-light's pixels up to BLOCK_SPARE
 * pixels away. */
#define BLOCK_SPARE 2

/* The distance, in pixels, of the four look-ups that stand for the pixels that a sub-light reads between
 * pixels: the square root of 1/6. Derived: the weights of bilinear look-ups, averaged over all positions
 * between pixels, form a tent function with the variance 1/6. */
#define SUBLIGHT_SPREAD 0.408248f

/* ---- the light of a sky ---- */

/* The greatest magnitude of a number that a cell of the sky's field stores. The numbers in a cell of the
 * sky's field have 16 bits. */
#define SKY_MOST 32767

/* A cell of the sky's field is SKY_CELL numbers of 16 bits. The function lanes_unpack_shorts() joins the
 * numbers of two cells, and changes the order of the numbers. SKY_PLACE() gives the index at which a harmonic
 * must be stored so that it becomes number `harmonic` of the sums. The indices SKY_PASSING and SKY_PASSING +
 * 1 hold no harmonic, but the transmittances of the cell and of the next cell along x; SKY_MOST stands for
 * 1. */
#define SKY_CELL            32
#define SKY_PASSING         28
#define SKY_PLACE(harmonic) ((harmonic) % 16 / 4 * 8 + (harmonic) % 4 + ((harmonic) < 16 ? 0 : 4))

/* The indices, among a cell's numbers, of three more numbers that are no harmonics: the fractions of the ways
 * to the next cell along x, y and z (axis 0, 1 and 2) at which a surface cuts the ways; SKY_MOST stands for
 * 1, and 0 for no surface. */
#define SKY_CUT(axis) ((axis) == 0 ? 23 : 29 + (axis))

/* The number of spherical harmonics, up to the second degree, and their factors. The harmonics have unit norm
 * over the sphere. */
#define FIELD_HARMONICS 9
#define HARMONIC_0      0.28209479177387814 /* harmonic of degree 0: 1 / sqrt(4 pi) */
#define HARMONIC_1      0.48860251190291992 /* harmonics of degree 1: sqrt(3 / (4 pi)) times x, y and z */
#define HARMONIC_2      1.09254843059207907 /* harmonics of degree 2: sqrt(15 / (4 pi)) x y, y z and z x */
#define HARMONIC_20     0.31539156525252000 /* harmonic of degree 2: sqrt(5 / (16 pi)) (3 z^2 - 1) */
#define HARMONIC_22     0.54627421529603953 /* harmonic of degree 2: sqrt(15 / (16 pi)) (x^2 - y^2) */

/* The least factor by which the trilinear weight of a cell of the sky's field is multiplied. LEAST_COUNTED is
 * also the least weight of the cell that no surface separates from the position. */
#define LEAST_COUNTED (1.0f / 1024)

/* The sky's field holds the light that reaches a cell, before the cell itself absorbs light. On its way to a
 * medium's sample, light crosses half of the cell. For a direction with the slopes u and v
 * (field/sky_lanes.h), half of the cell is half of sqrt(1 + u^2 + v^2) edges of a cell. The mean length of
 * the way through half a cell, over all directions, is 3 / (4 pi) times the integral of 1 / (1 + u^2 + v^2)
 * over -1 < u, v < 1 (derived). */
#define HALF_CELL 0.6107f

/* The greatest distance, in voxels, by which a sample is moved to the outside of its surface. */
#define MOST_TO_OUTSIDE 8.0f

#endif
