/* cli/suggest.c - finds suggestions for an unknown name: this program's names for words of ParaView, VTK,
 * ImageMagick, ffmpeg, Blender, Mitsuba and plotting libraries. */
#include "suggest.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <halflight/settings.h>

/* words: separated by blanks, in lower case */
static const struct {
  const char *option, *words;
} meanings[] = {
    {"output", "out outfile output-file file save screenshot image png write destination dest render-output"},
    {"format", "type filetype file-format output-format ext extension render-format"},
    {"size 3840x2160", "4k uhd"},
    {"size 1920x1080", "hd fullhd full-hd 1080p"},
    {"size",
     "height w h resolution res geometry resize scale dimensions image-size view-size window-size pixels "
     "film-size imagesize"},
    {"width", "figure-width paper-width print-width column-width"},
    {"dpi", "ppi pixels-per-inch print-resolution"},
    {"legend", "colorbar color-bar cbar colourbar colour-bar scalar-bar scalarbar"},
    {"scale-bar", "scalebar scalebars"},
    {"ruler X,Y,Z:X,Y,Z, or --marks for those of a scene",
     "rulers measure measurement measurements distance-ruler distance angle-mark dimension caliper"},
    {"font-size", "font fontsize text-size letter-size"},
    {"axes", "axis orientation-axes triad orientation-marker"},
    {"annotate", "annotation text title caption"},
    {"annotate A@0.03,0.05", "panel-label panel-letter letter"},
    {"preset light-sweep", "light-sweep sweep light-turn"},
    {"preset turntable", "turn-table rotation-film"},
    {"turntable", "orbit spin turn rotate rotation revolve revolutions"},
    {"key PATH=FRAME:VALUE,...", "keyframe keyframes keys path track tracks timeline"},
    {"ease smooth", "easing ease-in ease-out ease-in-out tween smoothstep interpolation"},
    {"frames N and --fps N", "duration seconds length film-length"},
    {"fps", "framerate frame-rate frames-per-second delay speed"},
    {"shrink 2", "scale resize resample downsample downscale bin binning subsample reduce factor size"},
    {"place", "legend-position legend-loc legend-place location position corner corners anchor"},
    {"depth", "bits bit-depth color-depth"},
    {"background", "bg background-color bgcolor background-colour canvas backdrop world-color transparent"},
    {"layers", "passes aov aovs buffers depth-map zbuffer normals render-layers"},
    {"azimuth",
     "rotate rotation yaw theta angle turn spin orbit rotate-z heading azim camera-position camera"},
    {"elevation", "pitch phi tilt altitude elev rotate-x inclination"},
    {"roll", "rotate-y bank twist"},
    {"up", "view-up viewup up-vector orientation"},
    {"up AXIS, as --up -z", "flip flip-z flip-y flip-x flipud upside-down invert-axis"},
    {"space RAS",
     "anatomical-space body-space coordinate-system directions axcodes axis-codes frame lps ras"},
    {"view", "viewpoint front back left right side top bottom camera-preset view-direction"},
    {"zoom", "zoom-in zoom-out zoom-factor dolly distance magnification crop-factor"},
    {"fovy", "fov field-of-view view-angle focal-length perspective vfov angle-of-view"},
    {"ortho", "orthographic parallel parallel-projection orthogonal ortho-scale"},
    {"tf",
     "opacity-curve alpha-curve colour-function color-function transfer-function transferfunction alpha-map "
     "transfer ctf otf presets opacity-function"},
    {"iso VALUE:COLOR:OPACITY for a surface, --show LABEL:OPACITY for a label, --density FACTOR for all "
     "matter, or --tf FILE for values",
     "opacity alpha transparency translucency"},
    {"color-by zmap.nii.gz:hot:2.5,7 and --color-by-threshold 2.5",
     "stat-map statmap zmap z-map overlay-threshold activation statistic"},
    {"color-by", "color-array colour-by colour-array color-volume texture-by coloring scalar-array"},
    {"colormap",
     "cmap color-map colourmap lut palette colors colours color colour color-table lookup-table colorscale"},
    {"range 1%,99%", "percentile percentiles quantile quantiles auto-contrast autoscale robust"},
    {"range-scale log", "log log-scale logscale logarithmic log-norm"},
    {"range",
     "clim window level window-level vmin vmax scalar-range data-range color-range rescale-range clims min "
     "max "
     "limits contrast"},
    {"threshold", "cutoff surface lower-threshold"},
    {"iso", "isovalue iso-value contour contours level-set isosurfaces iso-surface"},
    {"density", "opacity-scale density-scale extinction thickness thicker thinner opacity-multiplier"},
    {"slice",
     "slices section cross-section crosssection orthoslice mpr reslice reformat axial coronal sagittal "
     "plane-view"},
    {"clip", "crop cut roi clipping slab extent subset clip-box bbox"},
    {"cut-plane", "cutplane clipping-plane clip-plane plane"},
    {"cut-box", "octant cut-away cutaway remove"},
    {"cut-sphere", "sphere hole"},
    {"shading", "shade shader material lighting phong"},
    {"ambient", "ambient-light ambient-color fill-light"},
    {"sky", "skylight sky-light ambient-occlusion ao ssao environment-map dome environment-light hdri"},
    {"exposure", "brightness gain gamma intensity stops"},
    {"tone", "tonemap tone-map tone-mapping tonemapping filmic highlights rolloff"},
    {"look", "effect style mode blend-mode projection rendering-mode"},
    {"look mip", "mip maximum maximum-intensity maximum-intensity-projection max-projection"},
    {"look xray", "xray x-ray drr radiograph"},
    {"shadows off", "no-shadows noshadows without-shadows"},
    {"labels", "overlay atlas segmentation seg parcellation annotation-volume"},
    {"show", "label region regions organ roi-name structure"},
    {"whole", "keep-table show-table no-cut no-crop uncut keep-all keep-specks keep-islands show-all"},
    {"device", "gpu cuda opencl backend use-gpu"},
    {"scattering", "multiple-scattering sss subsurface subsurface-scattering bounces albedo"},
    {"outline", "box bounding-box bounds-box wireframe wire frame-box domain domain-outline show-bounds"},
    {"floor", "ground plate shadow-catcher table"},
    {"light",
     "light-direction light-dir light-position light-pos light-azimuth light-elevation sun key-light lamp "
     "light-angle key"},
    {"light-size", "softness light-radius angular-diameter sun-size penumbra blur source-size"},
    {"shadows", "shadow cast-shadows shadowing"},
    {"soft-method", "method shadow-method soft-shadows integrator algorithm"},
    {"light-samples", "shadow-samples nsamples sublights quality"},
    {"pixel-samples",
     "antialiasing anti-aliasing antialias aa supersampling supersample oversampling msaa ssaa spp samples "
     "sample-count samples-per-pixel"},
    {"shadow-resolution", "shadow-map-size shadow-map shadow-map-resolution"},
    {"sheet-spacing", "sample-distance sampling-rate step-size slice-distance sampling-distance rate sheets"},
    {"kernel", "interpolation filter reconstruction-filter interp sharp sharpness"},
    {"reference", "raymarch ray-march raytrace ground-truth"},
    {"step", "ray-step stepsize"},
    {"smooth", "smoothing blur-voxels gaussian gauss denoise"},
    {"spacing", "voxel-size voxelsize pixdim voxel-spacing pixel-size aspect sampling voxel"},
    {"array", "field scalars variable dataset array-name scalar variable-name"},
    {"component", "vector-component band index volume-index"},
    {"time", "timestep time-step frame t step-number"},
    {"channel", "ch wavelength color-channel"},
    {"level", "resolution scale-level pyramid-level lod mip-level"},
    {"threads", "jobs j cores cpus nthreads cpu num-threads workers"},
    {"max-memory", "memory mem ram memory-limit mem-limit"},
    {"instruction-set", "simd isa avx arch"},
    {"json", "stats statistics report info verbose debug"},
    {"quiet", "hide-progress silent no-progress q batch"},
    {"print-scene", "dump dump-scene save-scene export-scene scene print dry-run write-scene"},
    {"data", "data-dir data-folder include"},
    {"max-rmse", "rmse tolerance threshold metric fuzz"},
    {"frames", "runs repeat iterations n"},
};

static bool has_word(const char *words, const char *word) {
  size_t length = strlen(word);
  if (length == 0 || strchr(word, ' ') != NULL) return false;
  for (const char *at = words; (at = strstr(at, word)) != NULL; at++)
    if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
  return false;
}

/* Returns whether the list of options has the option in `meaning`, which may be followed by a value. */
static bool takes(const char *(*option)(const void *data, size_t index), const void *data,
                  const char *meaning) {
  const char *known;
  const size_t length = strcspn(meaning, " ");
  for (size_t i = 0; (known = option(data, i)) != NULL; i++)
    if (strlen(known) == length && strncmp(known, meaning, length) == 0) return true;
  return false;
}

const char *synonym_of(const char *word, const char *(*option)(const void *data, size_t index),
                       const void *data) {
  for (size_t n = 0; n < sizeof meanings / sizeof *meanings; n++)
    if (has_word(meanings[n].words, word) && takes(option, data, meanings[n].option))
      return meanings[n].option;
  return NULL;
}

/* words: separated by blanks, in lower case */
static const struct {
  const char *json, *words;
} settings[] = {
    {"\"material\": { \"emission\": 1 } in a volume", "emission emissive glow luminance self-illumination"},
    {"\"material\": { \"specular\": 0 } in a volume", "specular specularity gloss highlights"},
    {"\"material\": { \"diffuse\": 0.7 } in a volume", "diffuse"},
    {"\"material\": { \"shininess\": 32 } in a volume", "shininess roughness specular-power"},
    {"\"unit_distance\": 1 in a transfer function", "unit-distance opacity-unit-distance"},
    {"\"color\": [1, 0.5, 0.2] in a light", "light-color light-colour"},
    {"\"intensity\": 1 in a light", "light-intensity light-strength energy"},
    {"\"scattering\": { \"anisotropy\": 0.7 } in a volume",
     "phase-function henyey-greenstein forward-scattering g"},
    {"\"seed\": 7 in the hypertexture of a shape", "seed random-seed rng-seed"},
    {"\"target\" in \"camera\"", "target look-at lookat focal-point center centre"},
    {"\"position\" in \"camera\"", "eye eye-position position"},
};

/* Returns whether a word is the name of a key in an option's spelling: "opening-angle" of
 * "opening_angle_deg". */
static bool spells_key(const char *word, const char *key) {
  static const char unit[] = "_deg";
  size_t n = 0;
  while (key[n] != '\0' && word[n] == (key[n] == '_' ? '-' : key[n])) n++;
  return word[n] == '\0' && (key[n] == '\0' || strcmp(key + n, unit) == 0);
}

/* Finds the key of a scene that a word spells, and writes where it stands. */
static bool write_key(const char *word, char *text, size_t size) {
  static const struct {
    hl_setting_kind kind;
    const char *place;
  } places[] = {
      {HL_SETTINGS_VOLUME, "in a volume"},   {HL_SETTINGS_MATERIAL, "in the \"material\" of a volume"},
      {HL_SETTINGS_LIGHT, "in a light"},     {HL_SETTINGS_SKY, "in \"sky\""},
      {HL_SETTINGS_CAMERA, "in \"camera\""}, {HL_SETTINGS_MESH, "in a mesh"},
      {HL_SETTINGS_RENDER, "in \"render\""}, {HL_SETTINGS_CUT, "in one of the \"cuts\" of a volume"}};
  const hl_setting *setting;
  for (size_t p = 0; p < sizeof places / sizeof *places; p++)
    for (size_t n = 0; (setting = hl_setting_get(places[p].kind, n)) != NULL; n++) {
      const char *slash = strrchr(setting->key, '/'), *key = slash != NULL ? slash + 1 : setting->key;
      if (!spells_key(word, key)) continue;
      if (slash == NULL) snprintf(text, size, "\"%s\": ... %s", key, places[p].place);
      else
        snprintf(text, size, "\"%.*s\": { \"%s\": ... } %s", (int)(slash - setting->key), setting->key, key,
                 places[p].place);
      return true;
    }
  return false;
}

bool scene_setting_of(const char *word, char *text, size_t size) {
  for (size_t n = 0; n < sizeof settings / sizeof *settings; n++)
    if (has_word(settings[n].words, word)) {
      snprintf(text, size, "%s", settings[n].json);
      return true;
    }
  return write_key(word, text, size);
}

/* words: separated by blanks, in lower case */
static const struct {
  const char *sentence, *words;
} answers[] = {
    {"raw voxels have their size and type in the file's name, as in name_256x256x128_uint8.raw, or in a "
     "header "
     ".nhdr",
     "dims dim shape dtype data-type voxel-type endian byte-order raw raw-size header-size skip-bytes"},
    {"OUT is replaced without a question", "overwrite force clobber yes y f"},
    {"the ending of OUT chooses the kind of film; --keep-frames keeps the pictures for another encoder",
     "codec bitrate crf encoder vcodec"},
    {"the ending of OUT chooses the format, as in OUT.exr for linear light above white, or OUT.tif",
     "hdr exr tiff tif pdf svg"},
    {"'halflight view' shows the histogram of the values", "hist histogram"},
};

const char *answer_to(const char *word) {
  for (size_t n = 0; n < sizeof answers / sizeof *answers; n++)
    if (has_word(answers[n].words, word)) return answers[n].sentence;
  return NULL;
}

/* words: separated by blanks, in lower case */
static const struct {
  const char *option, *value, *words;
} values[] = {
    {"view", "front", "anterior coronal face ap"},
    {"view", "back", "posterior rear behind pa"},
    {"view", "left", "sagittal lateral side profile"},
    {"view", "top", "superior axial transverse above dorsal cranial"},
    {"view", "bottom", "inferior below underneath ventral caudal"},
    {"view", "iso", "isometric 3d diagonal corner three-quarter perspective"},
    {"shadows", "soft", "yes on true smooth area"},
    {"shadows", "off", "no none false never"},
    {"shadows", "hard", "sharp crisp"},
    {"light-rig", "studio", "three-point 3-point threepoint softbox portrait default"},
    {"light-rig", "raking", "grazing side relief low"},
    {"light-rig", "rim", "back backlight backlit contour silhouette edge"},
    {"light-rig", "overcast", "cloudy ambient dome sky diffuse"},
    {"look", "surface", "skin bone solid opaque isosurface shaded"},
    {"look", "translucent", "glass ghost transparent see-through clear volume"},
    {"look", "xray", "x-ray radiograph drr"},
    {"look", "vessels", "angio angiography angiogram mra cta arteries"},
    {"look", "smoke", "cloud fog medium gas fire"},
    {"look", "mip", "maximum max maxip"},
    {"tone", "filmic", "aces reinhard agx tonemapped hdr"},
    {"tone", "clip", "none linear srgb off standard"},
    {"kernel", "linear", "trilinear nearest"},
    {"kernel", "bspline", "cubic tricubic smooth"},
    {"axes", "letters", "anatomical orientation ras lps"},
    {"axes", "arrows", "xyz triad on yes"},
    {"format", "png", "jpg jpeg webp bmp gif"},
    {"format", "tif", "tiff"},
    {"device", "gpu", "cuda opencl"},
    {"preset", "--tf ct-bone", "ct-bone bone"},
    {"preset", "--tf ct-skin", "ct-skin skin"},
    {"preset", "--tf ct-soft-tissue", "ct-soft-tissue"},
    {"preset", "--tf mr-brain", "mr-brain brain"},
    {"preset", "--tf smoke", "smoke"},
    {"preset", "--tf electron-density", "electron-density"},
};

const char *value_meant_by(const char *option, const char *word) {
  for (size_t n = 0; n < sizeof values / sizeof *values; n++)
    if (strcmp(values[n].option, option) == 0 && has_word(values[n].words, word)) return values[n].value;
  return NULL;
}

/* words: separated by blanks, in lower case */
static const struct {
  const char *command, *words;
} commands[] = {
    {"view", "show open display viewer gui interactive web browse"},
    {"render",
     "draw image picture plot snapshot screenshot thumbnail export-image slice mip volume-render run start"},
    {"animate", "movie film video turntable anim animation rotate spin mp4 gif"},
    {"looks", "styles contact-sheet gallery thumbnails"},
    {"info", "stat stats header describe inspect ls list metadata"},
    {"convert", "resample crop resize downsample save translate mesh isosurface marching-cubes stl"},
    {"diff", "compare cmp difference psnr rmse"},
    {"bench", "benchmark time timing profile"},
    {"export", "html page webpage share"},
    {"figure", "panel panels montage layout"},
    {"figures", "paper examples"},
    {"help colormaps", "colormaps colormap colors colours cmaps luts palettes"},
    {"help presets", "presets preset"},
    {"devices", "gpus gpu cuda opencl"},
    {"make", "create generate new shape"},
};

const char *command_meant_by(const char *word) {
  for (size_t n = 0; n < sizeof commands / sizeof *commands; n++)
    if (has_word(commands[n].words, word)) return commands[n].command;
  return NULL;
}
