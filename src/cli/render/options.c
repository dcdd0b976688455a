/* cli/render/options.c - defines the table of options of `halflight render`. */
#include <math.h>
#include <string.h>

#include "cli/frames.h"
#include "cli/input.h"
#include "cli/output.h"
#include "figure_options.h"
#include "render.h"

static const cli_choice depths[] = {{"8", 8}, {"16", 16}, {NULL, 0}};
static const cli_choice formats[] = {{"png", 0}, {"exr", 1}, {"npy", 2}, {"tif", 3},
                                     {"pdf", 4}, {"svg", 5}, {NULL, 0}};
const cli_choice instruction_set_choices[] = {{"auto", HL_INSTRUCTION_SET_AUTO},
                                              {"scalar", HL_INSTRUCTION_SET_SCALAR},
                                              {"avx2", HL_INSTRUCTION_SET_AVX2},
                                              {"avx512", HL_INSTRUCTION_SET_AVX512},
                                              {"avx512-vbmi", HL_INSTRUCTION_SET_AVX512_VBMI},
                                              {"neon", HL_INSTRUCTION_SET_NEON},
                                              {NULL, 0}};

static const cli_choice all_times[] = {{"all", 0}, {NULL, 0}};

const cli_option render_options[RENDER_OPTION_COUNT] = {
    [RENDER_OUTPUT] = {.name = "output",
                       .letter = 'o',
                       .kind = OPTION_TEXT,
                       .argument = "OUT",
                       .group = "Picture",
                       .help =
                           "file to write: .png, .exr, .npy, .tif, .pdf or .svg\n(default: INPUT's name with "
                           ".png, in this folder). %s in\nit is INPUT's name, and a folder OUT is "
                           "OUT/%s.png; of\nseveral files each has a picture: %s.png, %04d.png"},
    [RENDER_FORMAT] = {.name = "format",
                       .kind = OPTION_CHOICE,
                       .choices = formats,
                       .help = "format of OUT where its name does not tell it\n(default png)"},
    [RENDER_SIZE] = {.name = "size",
                     .kind = OPTION_NUMBERS,
                     .argument = "WxH|N",
                     .help = "pixels; N: a square (default 512x512)",
                     .count = 2,
                     .separator = 'x',
                     .even = true,
                     .whole = true,
                     .setting_kind = HL_SETTINGS_IMAGE,
                     .setting = "width"},
    [RENDER_DEPTH] = {.name = "depth",
                      .kind = OPTION_CHOICE,
                      .choices = depths,
                      .help = "bits per channel of a .png or .tif (default 8)",
                      .hint = "; how far away things are is a channel of --layers"},
    [RENDER_NO_METADATA] = FRAMES_OPTION_NO_METADATA,
    [RENDER_BACKGROUND] = {.name = "background",
                           .kind = OPTION_COLOR,
                           .argument = "COLOR|transparent|sky",
                           .help = "colour under a .png: linear R,G,B 0..1, #rrggbb or a\nCSS name (both "
                                   "sRGB; default black, for bare volumes\ndark grey, black with --look "
                                   "mip); sky: shows the\nlight that comes from all directions",
                           .if_picture =
                               "to lay the picture over another one, give transparent, or an .exr as "
                               "the output",
                           .setting_kind = HL_SETTINGS_IMAGE,
                           .setting = "background"},
    [RENDER_EXPOSURE] =
        {.name = "exposure",
         .kind = OPTION_NUMBERS,
         .argument = "STOPS",
         .help = "a .png shows the volumes' light times 2^STOPS\n(default 0; the background stays)",
         .count = 1,
         .setting_kind = HL_SETTINGS_IMAGE,
         .setting = "exposure"},
    [RENDER_TONE] = {.name = "tone",
                     .kind = OPTION_CHOICE,
                     .help = "how a .png shows light brighter than white\n(default clip)",
                     .setting_kind = HL_SETTINGS_IMAGE,
                     .setting = "tone"},
    [RENDER_LAYERS] =
        {.name = "layers",
         .kind = OPTION_SWITCH,
         .help =
             "each light, its shadow, ambient, depth, normals:\nchannels of an .exr, files beside an .npy"},

    RENDER_FIGURE_OPTIONS,

    [RENDER_VIEW] =
        {.name = "view",
         .kind = OPTION_CHOICE,
         .argument = "SIDE",
         .group = "Camera",
         .help = "front, back, left, right, top, bottom or iso (the eye\n45 degrees right of front, 35 up; "
                 "of a file without\n"
                 "anatomy it sees the octant +x, -y, +z): of the body\nwhere the file knows it; frames anew "
                 "(default: a\nthree-quarter view, chosen)"},
    [RENDER_VIEWS] = {.name = "views",
                      .kind = OPTION_TEXT,
                      .argument = "SIDE,SIDE,...",
                      .help = "several sides (front,left,top) on one sheet, or in\nfiles: -o 'head-%s.png'"},
    [RENDER_UP] = {.name = "up",
                   .kind = OPTION_NUMBERS,
                   .argument = "AXIS|X,Y,Z",
                   .help =
                       "which way is up: an axis, as +z or -y, or a vector;\nframes anew (default: chosen)",
                   .count = 3,
                   .separator = ',',
                   .low = -INFINITY,
                   .high = INFINITY},
    [RENDER_AZIMUTH] = {.name = "azimuth",
                        .kind = OPTION_NUMBERS,
                        .argument = "DEG",
                        .help = "turns the view about up; 0 looks from the front (along\n+y where z is up), "
                                "positive moves the eye right\n(default: chosen)",
                        .count = 1,
                        .low = -360,
                        .high = 360},
    [RENDER_ELEVATION] = {.name = "elevation",
                          .kind = OPTION_NUMBERS,
                          .argument = "DEG",
                          .help = "height of the eye; 90 looks straight down (default 20,\nfor flat fields "
                                  "40, for heads and torsos 5)",
                          .count = 1,
                          .low = -90,
                          .high = 90},
    [RENDER_ROLL] = {.name = "roll",
                     .kind = OPTION_NUMBERS,
                     .argument = "DEG",
                     .help = "turns the picture clockwise if positive (default 0)",
                     .count = 1,
                     .low = -360,
                     .high = 360},
    [RENDER_ZOOM] = {.name = "zoom",
                     .kind = OPTION_NUMBERS,
                     .argument = "FACTOR",
                     .help = "1 shows everything (default); frames anew",
                     .count = 1,
                     .low = 0.001,
                     .high = 1000},
    [RENDER_FOVY] = {.name = "fovy",
                     .kind = OPTION_NUMBERS,
                     .argument = "DEG",
                     .help = "perspective with this vertical field of view\n(default 30)",
                     .count = 1,
                     .setting_kind = HL_SETTINGS_CAMERA,
                     .setting = "fovy_deg"},
    [RENDER_ORTHO] = {.name = "ortho",
                      .kind = OPTION_SWITCH,
                      .help = "parallel projection with the same framing"},

    [RENDER_ARRAY] = INPUT_OPTION_ARRAY("Volume files"),
    [RENDER_COMPONENT] = INPUT_OPTION_COMPONENT,
    [RENDER_SERIES] = INPUT_OPTION_SERIES,
    [RENDER_TIME] = {.name = "time",
                     .kind = OPTION_NUMBERS,
                     .argument = "N|all",
                     .help =
                         "the time step to read, from 0 (default: 0); all: a\npicture of each, numbered as "
                         "-o 'frames/%04d.png' says",
                     .choices = all_times,
                     .count = 1,
                     .whole = true,
                     .low = 0,
                     .high = 1e9},
    [RENDER_LEVEL] = INPUT_OPTION_LEVEL,
    [RENDER_CHANNEL] = INPUT_OPTION_CHANNELS,
    [RENDER_SPACING] = INPUT_OPTION_SPACING,
    [RENDER_SPACE] = INPUT_OPTION_SPACE,
    [RENDER_SMOOTH] =
        {.name = "smooth",
         .kind = OPTION_NUMBERS,
         .argument = "SIGMA",
         .help = "smooth the voxels by a Gaussian of SIGMA voxels along\neach axis; 0: do not "
                 "smooth (default: 0.8 where bare\nbrains or thick slices make stairs, or noise makes grain)",
         .count = 1,
         .low = 0,
         .high = 16},

    [RENDER_LOOK] =
        {.name = "look",
         .kind = OPTION_CHOICE,
         .group = "Look (of every volume)",
         .help = "auto, surface, translucent, xray, smoke or vessels,\nwhich 'halflight looks' shows; or "
                 "mip: the greatest\nvalue along each ray (default auto: chosen from the\ndata)"},
    [RENDER_TF] =
        {.name = "tf",
         .also = "preset",
         .kind = OPTION_TEXT,
         .argument = "[NAME=]FILE|PRESET",
         .help =
             "transfer function: a JSON file (Halflight's, a\nscene's first, ParaView's; or its .pvsm), "
             "Slicer's\n(.vp.json, .vp, presets.xml:NAME) or a preset, see\n'halflight help presets'; with "
             "NAME=, for the volume\nNAME only (give it again for others; default: chosen from\nthe data)",
         .repeatable = true},
    [RENDER_COLORMAP] =
        {.name = "colormap",
         .kind = OPTION_TEXT,
         .argument = "[NAME=]MAP|COLOR",
         .help = "colours over the visible values, see\n'halflight help colormaps'; or one colour as #rrggbb "
                 "or\na CSS name (in a maximum projection from black to it);\nNAME as for --tf, or a mesh's "
                 "(a COLOR); or one for "
                 "each volume or\nchannel, in order (magma,viridis)",
         .repeatable = true},
    [RENDER_COLOR_BY] =
        {.name = "color-by",
         .kind = OPTION_TEXT,
         .argument = "FILE[:ARRAY][:MAP[:LO,HI]]",
         .help = "colours of the values that another volume, FILE, has at\nthe same place; "
                 "opacity stays; ARRAY, of FILE, or alone of\nthe input; MAP: a colormap (default "
                 "viridis) over the\nvalues LO to HI (default: all)",
         .hint = ", as temperature.nrrd:inferno:300,2000"},
    [RENDER_COLOR_BY_THRESHOLD] =
        {.name = "color-by-threshold",
         .kind = OPTION_NUMBERS,
         .argument = "T|LO,HI",
         .help = "with --color-by, matter keeps its own colour where the\nother values are below T, or "
                 "between LO and HI: a\nstatistical map on a surface (2.5, or -2.5,2.5)",
         .count = 2,
         .separator = ',',
         .even = true,
         .low = -INFINITY,
         .high = INFINITY},
    [RENDER_RANGE] = {.name = "range",
                      .kind = OPTION_NUMBERS,
                      .argument = "[NAME=]LO,HI",
                      .help = "values over which opacity and colours spread (what is\nclear stays clear, "
                              "with --colormap), or the\nwindow of greys on cut faces of a body; or "
                              "percentiles of\nthe data (1%,99.5%); give it again for other volumes or\n"
                              "channels: NAME= as for --tf",
                      .count = 2,
                      .separator = ',',
                      .percent = true,
                      .named = true,
                      .repeatable = true,
                      .low = -INFINITY,
                      .high = INFINITY},
    [RENDER_RANGE_SCALE] = {.name = "range-scale",
                            .kind = OPTION_CHOICE,
                            .help = "linear: opacity and colours spread evenly over --range;\nlog: over the "
                                    "logarithms of its values"},
    [RENDER_RANGE_OF_ALL] = {.name = "range-of-all",
                             .kind = OPTION_SWITCH,
                             .help = "for a series of files: --range from the least to the\ngreatest value "
                                     "of all files (default: the first\nfile's look)"},
    [RENDER_THRESHOLD] = {.name = "threshold",
                          .kind = OPTION_NUMBERS,
                          .argument = "[NAME=]V",
                          .help = "opaque from the value V on, clear below; give it again for\nother volumes "
                                  "or channels: NAME= as "
                                  "for --tf",
                          .count = 1,
                          .named = true,
                          .repeatable = true,
                          .low = -INFINITY,
                          .high = INFINITY},
    [RENDER_ISO] =
        {.name = "iso",
         .also = "isosurface",
         .kind = OPTION_TEXT,
         .argument = "[NAME=]VALUE[:COLOR[:OPACITY]]",
         .help =
             "the surface on which the volume has this value; it\nreplaces the transfer function, or stands "
             "beside it\nwith --tf or --look; give it again for more surfaces\n(--iso 80:skyblue:0.3), or "
             "several values (30,90)",
         .hint = ", as 80:skyblue:0.3, with a value of the volume",
         .repeatable = true},
    [RENDER_DENSITY] = {.name = "density",
                        .kind = OPTION_NUMBERS,
                        .argument = "FACTOR",
                        .help = "all matter is so many times as dense: 3 makes smoke and\nglass thicker, 0.3 "
                                "thinner (default 1)",
                        .count = 1,
                        .low = 0,
                        .above = true,
                        .high = 1e9},
    [RENDER_SLICE] =
        {.name = "slice",
         .kind = OPTION_TEXT,
         .argument = "AXIS[=AT]",
         .help = "a slice across x, y or z, as in radiology: its values in\ngrey, or as "
                 "--colormap and --range say, with labels of\n--labels or --mask over them; AXIS: "
                 "also axial, coronal or\nsagittal; AT: "
                 "a fraction (z=0.5; the middle if it is\nleft out), or a length (z=40mm; u: the "
                 "file's own unit);\na volume with a --colormap lies over those before it,\nfrom the "
                 "low end of its --range on",
         .hint = ", as z=0.5"},
    [RENDER_CLIP] = {.name = "clip",
                     .kind = OPTION_TEXT,
                     .argument = "[NAME=]AXIS=LO:HI,...",
                     .help =
                         "keep a part along x, y or z: fractions\n(x=0:0.5,z=0.2:), or lengths (x=10mm:40mm; "
                         "u: the\nfile's own unit); NAME= as for --tf",
                     .hint = ", as x=0:0.5",
                     .repeatable = true},
    [RENDER_CUT_PLANE] =
        {.name = "cut-plane",
         .kind = OPTION_TEXT,
         .argument = "[NAME=]X,Y,Z:NX,NY,NZ",
         .help =
             "cut away everything beyond a plane through a point\n(fractions, or lengths such as 40mm), in "
             "a direction;\nx=0.5 is short for a plane across x, "
             "and x=:0.5 cuts\nthe other side away; give it again for more planes;\nwith NAME= (brain=x=0.5) "
             "it cuts one volume alone",
         .repeatable = true},
    [RENDER_CUT_BOX] = {.name = "cut-box",
                        .kind = OPTION_TEXT,
                        .argument = "[NAME=]AXIS=LO:HI,...",
                        .help = "cut a box out (x=0.5:,y=:0.5,z=0.5: is an octant);\ngive it again for more "
                                "boxes; NAME= as for --cut-plane",
                        .hint = ", as x=0.5:,y=:0.5,z=0.5:",
                        .repeatable = true},
    [RENDER_CUT_SPHERE] =
        {.name = "cut-sphere",
         .kind = OPTION_TEXT,
         .argument = "[NAME=]X,Y,Z:RADIUS",
         .help =
             "cut a sphere out (0.5,0.5,1:0.3); give it again for more\nspheres; NAME= as for --cut-plane",
         .repeatable = true},
    [RENDER_CUT_SHADING] =
        {.name = "cut-shading",
         .kind = OPTION_CHOICE,
         .help = "how surfaces at the faces of cuts and --clip are lit:\nby the face, by the data's "
                 "gradient, or as a medium",
         .setting_kind = HL_SETTINGS_VOLUME,
         .setting = "cut_shading"},
    [RENDER_CUT_CASTS_SHADOW] = {.name = "cut-casts-shadow",
                                 .kind = OPTION_SWITCH,
                                 .help = "matter that is cut away still casts its shadow"},
    [RENDER_WHOLE] = {.name = "whole",
                      .kind = OPTION_SWITCH,
                      .help = "show a bare volume whole: with tables, head rests and\ntowels beside a "
                              "scanned object, which are otherwise cut\naway, and with the small bodies "
                              "beside it, which are\notherwise hidden"},
    [RENDER_SHADING] = {.name = "shading",
                        .kind = OPTION_CHOICE,
                        .help = "surfaces, a medium such as smoke, or the\ncolours themselves without light "
                                "(default phong;\nfor smoke none)",
                        .setting_kind = HL_SETTINGS_VOLUME,
                        .setting = "shading"},
    [RENDER_SCATTERING] = {.name = "scattering",
                           .kind = OPTION_COLOR,
                           .argument = "ALBEDO",
                           .help =
                               "media scatter light again and again, as clouds and\nwax do, and keep this "
                               "fraction of it each time: 0.9,\nor R,G,B",
                           .setting_kind = HL_SETTINGS_VOLUME,
                           .setting = "scattering/albedo"},
    [RENDER_FLOOR] = {.name = "floor",
                      .kind = OPTION_SWITCH,
                      .help = "a floor below everything that is seen, three times as\nwide, which receives "
                              "its shadow and is not cut"},
    [RENDER_OUTLINE] = {.name = "outline",
                        .kind = OPTION_SWITCH,
                        .help = "the edges of the volumes' boxes as thin grey wires, also\nof the part that "
                                "cuts take away"},
    [RENDER_RULER] =
        {.name = "ruler",
         .kind = OPTION_TEXT,
         .argument = "X,Y,Z:X,Y,Z[:TEXT]",
         .help = "draw the distance between two points (fractions of the\nbox, or lengths such as "
                 "40mm) with its length, after TEXT;\nthe scene keeps it as a mark; give it again for "
                 "more",
         .repeatable = true},

    [RENDER_LABELS] = {.name = "labels",
                       .kind = OPTION_TEXT,
                       .argument = "FILE",
                       .group = "Label maps",
                       .help =
                           "a label map or segmentation (.seg.nrrd, NIfTI, ...)\nin the same world: smooth "
                           "surfaces in colours"},
    [RENDER_MASK] = {.name = "mask",
                     .kind = OPTION_TEXT,
                     .argument = "FILE",
                     .help = "a label map that reveals, colours and fades the\nvolumes within its labels: "
                             "the labels of --show, or all;\n--show all=own colours them as the labels are"},
    [RENDER_LABEL_TABLE] = {.name = "label-table",
                            .kind = OPTION_TEXT,
                            .argument = "FILE",
                            .help =
                                "names and colours of labels: FreeSurfer's, Slicer's\nor ITK-SNAP's table, "
                                "or CSV"},
    [RENDER_SHOW] = {.name = "show",
                     .kind = OPTION_TEXT,
                     .argument = "LABEL[=COLOR][:OPACITY],...",
                     .help = "labels to show, by name or number:\nliver,tumour=red:0.5,rest:0.1; =own: the "
                             "label's own\ncolour, "
                             "for --mask; rest: all others together,\nwith --mask what lies beside it (a "
                             "label of the name\nrest or all: its number); "
                             "without either INPUT is\nthe label map",
                     .repeatable = true},

    [RENDER_AMBIENT] = {.name = "ambient",
                        .kind = OPTION_COLOR,
                        .argument = "COLOR",
                        .group = "Light and shadows",
                        .help = "light from everywhere: a number for grey, linear\nR,G,B, #rrggbb or a CSS "
                                "name (default 0.2; for bare\nvolumes chosen)",
                        .setting_kind = HL_SETTINGS_SCENE,
                        .setting = "ambient"},
    [RENDER_SKY] =
        {.name = "sky",
         .also = "environment",
         .kind = OPTION_TEXT,
         .argument = "SKY",
         .help = "light from all directions, which folds and\nhollows get less of: a colour, a "
                 "gradient\nZENITH:HORIZON[:GROUND], or an image's file\n(.exr, .hdr, .png, .npy); 0: none",
         .setting_kind = HL_SETTINGS_SKY,
         .setting = "color"},
    [RENDER_LIGHT_RIG] = {.name = "light-rig",
                          .kind = OPTION_CHOICE,
                          .help = "lights that go with the camera, and a sky; they replace\nthe scene's"},
    [RENDER_LIGHT] = {.name = "light",
                      .kind = OPTION_NUMBERS,
                      .argument = "AZ,EL",
                      .help = "direction of the first light, seen from the\ncamera: 0,0 is a headlight, "
                              "-40,40 upper left\n(default -40,45; for bare smoke -75,40)",
                      .count = 2,
                      .separator = ',',
                      .low = -360,
                      .high = 360},
    [RENDER_LIGHT_SIZE] = {.name = "light-size",
                           .kind = OPTION_NUMBERS,
                           .argument = "DEG",
                           .help = "angular diameter of the first light; 0 is hard\n(default 7; with --light "
                                   "in a scene that has no\nlight 0)",
                           .count = 1,
                           .setting_kind = HL_SETTINGS_LIGHT,
                           .setting = "angular_diameter_deg"},
    [RENDER_SHADOWS] = {.name = "shadows",
                        .kind = OPTION_CHOICE,
                        .help = "shadows of all lights that cast any (default soft)",
                        .setting_kind = HL_SETTINGS_RENDER,
                        .setting = "shadows"},
    [RENDER_SOFT_METHOD] = {.name = "soft-method",
                            .kind = OPTION_CHOICE,
                            .help = "how soft shadows are made (default cascade)",
                            .setting_kind = HL_SETTINGS_RENDER,
                            .setting = "soft_method"},
    [RENDER_LIGHT_SAMPLES] = {.name = "light-samples",
                              .kind = OPTION_NUMBERS,
                              .argument = "M",
                              .help = "sublights: M x M parts of each light (default 4)",
                              .count = 1,
                              .whole = true,
                              .setting_kind = HL_SETTINGS_RENDER,
                              .setting = "light_samples"},
    [RENDER_SHADOW_RESOLUTION] = {.name = "shadow-resolution",
                                  .kind = OPTION_NUMBERS,
                                  .argument = "N|auto",
                                  .help = "longer side of the shadow buffer, in pixels\n(default auto: as "
                                          "fine as the volumes and the\npicture want)",
                                  .count = 1,
                                  .whole = true,
                                  .setting_kind = HL_SETTINGS_RENDER,
                                  .setting = "shadow_resolution"},
    [RENDER_SHADOW_LOOKUP] = {.name = "shadow-lookup",
                              .kind = OPTION_CHOICE,
                              .help = "how the shadow buffer is read (default auto: cubic\nor bilinear)",
                              .setting_kind = HL_SETTINGS_RENDER,
                              .setting = "shadow_lookup"},

    [RENDER_SHEET_SPACING] =
        {.name = "sheet-spacing",
         .kind = OPTION_NUMBERS,
         .argument = "VOXELS",
         .group = "Sheets",
         .help =
             "distance of sheets in smallest voxel edges\n(default 0.5; of bare volumes 0.125 to 1, chosen)",
         .count = 1,
         .setting_kind = HL_SETTINGS_RENDER,
         .setting = "sheet_spacing"},
    [RENDER_PIXEL_SAMPLES] = {.name = "pixel-samples",
                              .kind = OPTION_NUMBERS,
                              .argument = "N",
                              .help =
                                  "at least N x N samples in a pixel: smooth edges of\ncut faces, in about "
                                  "N x N times the time (default:\n1, more where voxels are smaller than "
                                  "pixels)",
                              .count = 1,
                              .whole = true,
                              .setting_kind = HL_SETTINGS_RENDER,
                              .setting = "pixel_samples"},
    [RENDER_KERNEL] = {.name = "kernel",
                       .kind = OPTION_CHOICE,
                       .help = "how values between voxels are found (default bspline;\nlinear for bare label "
                               "maps drawn by their numbers)",
                       .setting_kind = HL_SETTINGS_RENDER,
                       .setting = "kernel"},
    [RENDER_RECONSTRUCTION] =
        {.name = "reconstruction",
         .kind = OPTION_CHOICE,
         .help = "push footprints, or pull samples: the same\npicture to rounding (default auto)",
         .setting_kind = HL_SETTINGS_RENDER,
         .setting = "reconstruction"},
    [RENDER_SLICING] = {.name = "slicing",
                        .kind = OPTION_CHOICE,
                        .help = "direction of the sheets (default half-vector)",
                        .setting_kind = HL_SETTINGS_RENDER,
                        .setting = "slicing"},

    [RENDER_REFERENCE] =
        {.name = "reference",
         .kind = OPTION_SWITCH,
         .group = "Reference",
         .help = "march rays instead: exact, and very slow; how long it\ntakes is said while it runs"},
    [RENDER_LIGHT_POINTS] = {.name = "light-points",
                             .kind = OPTION_NUMBERS,
                             .argument = "N",
                             .help = "its points on each extended light (default 1024)",
                             .count = 1,
                             .whole = true,
                             .low = 1,
                             .high = 1000000},
    [RENDER_STEP] = {.name = "step",
                     .kind = OPTION_NUMBERS,
                     .argument = "VOXELS",
                     .help = "its step in smallest voxel edges (default 0.25)",
                     .count = 1,
                     .low = 0.001,
                     .high = 10},
    [RENDER_PATHS] = {.name = "paths",
                      .kind = OPTION_NUMBERS,
                      .argument = "N",
                      .help = "its paths a pixel, of light that media scatter\nagain (default 64)",
                      .count = 1,
                      .whole = true,
                      .low = 1,
                      .high = 1 << 24},
    [RENDER_RAYS] = {.name = "rays",
                     .kind = OPTION_NUMBERS,
                     .argument = "N",
                     .help =
                         "its N x N rays through each pixel, at most 8 x 8 (default:\nas many as the sheets "
                         "average)",
                     .count = 1,
                     .whole = true,
                     .low = 1,
                     .high = 8},

    [RENDER_DATA] = HOST_OPTION_DATA("Running"),
    [RENDER_PART] = FRAMES_OPTION_PART(
        NULL,
        "render every N-th file of a series, from the K-th on, so\nthat N runs "
        "share the work"),
    [RENDER_RANKS] = FRAMES_OPTION_RANKS,
    [RENDER_STRIPS] = {.name = "strips-over-ranks",
                       .kind = OPTION_SWITCH,
                       .joins = true,
                       .help = "under mpirun: its processes make one picture together,\neach a part of it"},
    [RENDER_VOLUME] = {.name = "volume-over-ranks",
                       .kind = OPTION_SWITCH,
                       .joins = true,
                       .help =
                           "and each reads and holds its own slices of the\nvolumes, and asks the others for "
                           "theirs; up to\n--max-memory of them is kept"},
    [RENDER_THREADS] = HOST_OPTION_THREADS(NULL),
    [RENDER_INSTRUCTION_SET] =
        {.name = "instruction-set",
         .kind = OPTION_CHOICE,
         .choices = instruction_set_choices,
         .help = "any gives the same picture (default auto: the\nfastest that the processor has)"},
    [RENDER_DEVICE] = HOST_OPTION_DEVICE,
    [RENDER_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [RENDER_PRINT_SCENE] =
        {.name = "print-scene",
         .kind = OPTION_SWITCH,
         .help = "the scene on standard output, no picture: a\nscene file that gives the same bytes"},
    [RENDER_PRINT_PLAN] = {.name = "print-plan",
                           .kind = OPTION_SWITCH,
                           .help = "the frame's plan as JSON on standard output, no\npicture: sheets, "
                                   "sweeps, lights and their buffers"},
    [RENDER_JSON] = {.name = "json", .kind = OPTION_SWITCH, .help = "statistics on standard output"},
    [RENDER_QUIET] = {.name = "quiet", .kind = OPTION_SWITCH, .help = "nothing on standard error but errors"},
};
