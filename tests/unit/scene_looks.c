/* tests/unit/scene_looks.c - the kinds for which volumes are taken, and how they are then shown. */
#include "guess/looks.h"
#include "image/srgb.h"
#include "looks_volumes.h"
#include "scene_parts.h"

/* A casting of metal in place of the body. */
static double casting(int i, int j, int k) {
  return body(i, j, k) > -400 ? 2400 + 60 * noise(i, j, k) : -1000 + 60 * noise(i, j, k);
}

static double eight_bits(int i, int j, int k) { return floor((body(i, j, k) + 1100) / 8.3); }

/* A body that a program has cut out, so that everything else is 0. */
static double cut_out(int i, int j, int k) {
  return distance(i, j, k, 24, 23, 25) < 17
             ? 100 + 40 * (distance(i, j, k, 24, 23, 25) < 11) + 30 * noise(i, j, k)
             : 0;
}

static double twigs(int i, int j, int k) { /* a few thin rods in noisy air */
  bool rod = hypot(i - 10, j - 30) < 2 || hypot(j - 12, k - 20) < 2 || hypot(i - 30, k - 33) < 2;
  return (rod ? 150 : 8) + 12 * noise(i, j, k);
}

static double mask(int i, int j, int k) { return distance(i, j, k, 24, 24, 24) < 15; }
static double whole_noise(int i, int j, int k) { return floor(40 * (noise(i, j, k) + 0.5)); }
/* Waves of many directions fill the grid, around a mean. */
static double waves(int i, int j, int k) {
  double sum = 0;
  for (int n = 1; n <= 12; n++)
    sum += sin(0.05 * n * i + 2.1 * n) * sin(0.37 * n + 0.06 * (13 - n) * j) * sin(0.045 * n * k + n);
  return sum;
}
static double density(int i, int j, int k) { return 20 + waves(i, j, k); }
static double gradient(int i, int j, int k) { return 300 + 2 * i + 0.1 * j + 0.01 * k; }
static double orbital(int i, int j, int k) { /* lobes of the greatest value on zeros */
  double lobe = 3 * exp(-pow(distance(i, j, k, 15, 24, 24) / 7, 2)) -
                3 * exp(-pow(distance(i, j, k, 33, 24, 24) / 7, 2));
  return fabs(lobe) < 0.05 ? 0 : fmax(-1, fmin(1, lobe));
}

/* An oblique membrane in one half of tissue that is as bright as vessels. */
static double membrane(int i, int j, int k) {
  double from = fabs(k - 24 - 0.3 * i + 0.2 * j);
  return tissue(i, j, k, i < 24 ? 1.2 - from : 0);
}
/* The temperature of a flame, which is highest in a shell; and the same as a scanner would measure it. */
static double flame(int i, int j, int k) {
  double sway = 3 * sin(0.3 * k), wide = 5 + 0.12 * k, r = hypot(i - 24 - sway, j - 24 + 0.5 * sway) / wide,
         fuel = exp(-r * r);
  return 300 + 1800 * (fuel < 0.2 ? fuel / 0.2 : 1 - (fuel - 0.2));
}
static double noisy_flame(int i, int j, int k) { return flame(i, j, k) + 60 * noise(i, j, k); }

/* Turbulent air has values on both sides of its mean. So has noise, which is no flow. */
static double noise_about_a_mean(int i, int j, int k) {
  double sum = 0;
  for (int n = 0; n < 6; n++) sum += noise(i + 50 * n, j, k);
  return 120 + 20 * sum;
}

static const char *guess(hl_context *context, double (*each)(int, int, int), const char *file) {
  const char *kind = NULL;
  fill(each);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_volume_guess(volume, file, &kind, NULL), HL_OK);
  hl_volume_release(volume);
  return kind;
}

static void kinds_are_told_apart(void **state) {
  (void)state;
  static const struct {
    double (*each)(int, int, int);
    const char *file, *kind;
  } cases[] = {{body, NULL, "scanned body"},
               {casting, NULL, "scanned matter"},
               {eight_bits, NULL, "scanned matter"},
               {eight_bits, "a.nii.gz", "scanned body"},
               {cut_out, "a.nii", "scanned brain"},
               {cut_out, NULL, "scanned matter"},
               {twigs, "tree.nii", "scanned matter"},
               {regions, NULL, "labels"},
               {mask, NULL, "labels"},
               {waves, NULL, "signed field"},
               {density, NULL, "flow"},
               {gradient, NULL, "flow"},
               {orbital, NULL, "signed field"},
               {ball_of_bytes, NULL, "scanned matter"},
               {angiogram, NULL, "vessels"},
               {angiogram, "a.nii", "vessels"},
               {membrane, NULL, "scanned matter"},
               {beads, NULL, "scanned matter"},
               {flame, NULL, "field"},
               {noisy_flame, NULL, "scanned matter"},
               {noise_about_a_mean, NULL, "scanned matter"}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    const char *kind = guess(context, cases[n].each, cases[n].file);
    if (strcmp(kind, cases[n].kind) != 0) fail_msg("case %zu: %s in place of %s", n, kind, cases[n].kind);
  }
  assert_string_not_equal(guess(context, whole_noise, NULL), "labels");
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static double puff(int i, int j, int k) { /* values fall off smoothly, and end */
  double value = exp(-pow(distance(i, j, k, 24, 24, 24) / 9, 2));
  return value < 0.01 ? 0 : value;
}
static double filled(int i, int j, int k) { /* a solid with a soft border */
  return fmax(0, fmin(1, (15 - distance(i, j, k, 24, 24, 24)) / 2));
}

/* A file may say that its values are a fog. That counts if they may be one, whatever the grid's name is. */
static void fog_is_believed_where_the_data_may_be_fog(void **state) {
  (void)state;
  static const struct {
    double (*each)(int, int, int);
    const char *kind, *said; /* the kinds without the file's statement and with it */
  } cases[] = {{puff, "field", "smoke or cloud"},
               {filled, "scanned matter", "smoke or cloud"},
               {orbital, "signed field", "signed field"},
               {eight_bits, "scanned matter", "scanned matter"},
               {body, "scanned body", "scanned body"}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    const char *kind = NULL;
    fill(cases[n].each);
    hl_volume *volume = make_volume(context, N, values);
    volume->says_fog = true;
    assert_int_equal(hl_volume_guess(volume, NULL, &kind, NULL), HL_OK);
    assert_string_equal(kind, cases[n].said);
    hl_volume_release(volume);
    assert_string_equal(guess(context, cases[n].each, NULL), cases[n].kind);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* In an angiogram the tissue is transparent, and the vessels show. */
static void angiograms_show_vessels(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  const char *next = NULL;
  fill(angiogram);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  assert_true(hl_transfer_function_opacity(&f, 140) == 0 && hl_transfer_function_opacity(&f, 380) > 0.9);
  assert_int_equal(hl_volume_next_look(volume, NULL, &next, NULL), HL_OK);
  assert_string_equal(next, "surface");
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A quantity that has both signs everywhere shows its strongest lobes, which are few voxels. */
static void strong_lobes_alone_are_seen(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  fill(waves);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  int seen = 0;
  for (int v = 0; v < COUNT; v++) seen += hl_transfer_function_opacity(&f, (double)values[v]) > 0.1;
  assert_true(seen > COUNT / 100 && seen < COUNT / 8);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static double cloud_of_charge(int i, int j, int k) {
  return 100 * exp(-pow(distance(i, j, k, 24, 24, 24) / 9, 2));
}

/* A field shows an opaque core through a thin shell, which lets more than half of the light pass. */
static void fields_show_a_core_through_a_shell(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  hl_data_analysis a;
  fill(cloud_of_charge);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(a.kind, HL_DATA_FIELD);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  double core = a.background + a.solid + 0.35 * (a.top - a.solid), clear = 1;
  const double step = 0.05; /* voxels */
  for (double x = 0; x < 24; x += step) {
    double value = 100 * exp(-pow((24 - x) / 9, 2));
    if (value > core - 0.04 * a.top) break;
    clear *= pow(1 - hl_transfer_function_opacity(&f, value), step);
  }
  assert_true(clear > 0.5 && clear < 0.9);
  assert_true(hl_transfer_function_opacity(&f, core) > 0.8 && hl_transfer_function_opacity(&f, 100) > 0.8);
  double from = a.background + a.faint, shell = from + 0.35 * (a.solid - a.faint),
         opacity = hl_transfer_function_opacity(&f, shell);
  assert_true(opacity > 3 * hl_transfer_function_opacity(&f, from + 0.02 * a.top));
  for (double value = shell + 0.04 * a.top; value < core - 0.04 * a.top; value += 0.02 * a.top)
    assert_true(hl_transfer_function_opacity(&f, value) < 0.02 * opacity);
  double glass[3];
  hl_transfer_function_color(&f, shell, glass);
  for (int c = 0; c < 3; c++) assert_true(glass[c] > 0.15); /* no part of the shell's colour is dark */
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A bright inside under a skin that is a third as bright, both with noise. */
static double dark_skin(int i, int j, int k) {
  double r = distance(i, j, k, 24, 24, 24), skin = 22 / (1 + exp((r - 21) / 0.4)),
         inside = 50 / (1 + exp((r - 16) / 0.4));
  return 2 + skin + inside + 3 * noise(i, j, k) + (r < 21 ? 24 * noise(k, i, j) : 0);
}

/* The surface lies where the dark skin begins, and not where the skin's noise crosses a value of the skin. */
static void dark_skin_is_whole(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  fill(dark_skin);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  int skin = 0, whole = 0, air = 0;
  for (int v = 0; v < COUNT; v++) {
    double r = distance(v % N, v / N % N, v / N / N, 24, 24, 24),
           opacity = hl_transfer_function_opacity(&f, (double)values[v]);
    skin += r > 17 && r < 20;
    whole += r > 17 && r < 20 && opacity > 0.5;
    air += r > 23 && opacity > 0.01;
  }
  assert_true(whole > 0.9 * skin);
  assert_int_equal(air, 0);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* On a cut through a body, flesh is redder than the skin around it, and bone is nearly white. */
static void cut_faces_tell_flesh_from_bone(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  double skin[3], flesh[3], bone[3];
  fill(body);
  hl_volume *volume = make_volume(context, N, values);
  hl_data_analysis a;
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  hl_transfer_function_color(&f, a.background + a.solid, skin);
  hl_transfer_function_color(&f, 40, flesh);
  hl_transfer_function_color(&f, 940, bone);
  assert_true(flesh[1] / flesh[0] < 0.9 * skin[1] / skin[0]);
  assert_true(bone[1] / bone[0] > 0.8 && bone[1] > 2 * flesh[1]);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* The brightness of a transfer function's colour for a value, as a number of 8 bits of a .png. */
static double level_of(const hl_transfer_function *function, double value) {
  double color[3];
  hl_transfer_function_color(function, value, color);
  return 255 * hl_srgb_encode_number(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
}

/* The difference in brightness between two values, by the look that suits the volume. */
static double contrast(hl_context *context, double (*each)(int, int, int), const char *file, double dark,
                       double light) {
  hl_data_analysis a;
  hl_transfer_function f;
  fill(each);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(hl_look_write(hl_look_for(volume, file, &a), NULL, context, volume, &a, &f, NULL), HL_OK);
  double levels = level_of(&f, light) - level_of(&f, dark);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  return levels;
}

/* On the faces of cuts, two tissues differ as grey and white matter differ in a slice: in a brain, in matter
 * that may be a head, and in a CT, in which the fluid of a brain has about 0 Hounsfield units and the brain
 * about 30. */
static void cut_faces_tell_tissues(void **state) {
  (void)state;
  hl_context *context = make_context();
  assert_true(contrast(context, cut_out, "a.nii", 100, 140) > 40);
  assert_true(contrast(context, head_in_mr, NULL, 60, 90) > 33);
  assert_true(contrast(context, eight_bits, "a.nii", 1140 / 8.3, 2000 / 8.3) > 40);
  assert_true(contrast(context, body, NULL, 0, 30) > 12);
  hl_context_destroy(context);
}

/* The opacity of a ball of noisy material at values that are surely its matter. */
static double opacity_of_ball(hl_context *context, double radius) {
  hl_transfer_function f;
  for (int v = 0; v < COUNT; v++) {
    const int i = v % N, j = v / N % N, k = v / N / N;
    double r = distance(i, j, k, 24, 24, 24);
    values[v] = (float)(100 / (1 + exp((r - radius) / 0.7)) + 60 / (1 + exp((r - 0.4 * radius) / 0.7)) +
                        20 * noise(i, j, k));
  }
  hl_volume *volume = make_volume(context, N, values);
  hl_data_analysis a;
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(a.kind, HL_DATA_SURFACES);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  double opacity = hl_transfer_function_opacity(&f, a.background + a.solid);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  return opacity;
}

/* The value above which a ball of 100 in noisy air is surely matter. `hot` voxels of the volume are a
 * thousand times as bright. */
static double solid_beside_hot_voxels(hl_context *context, int hot) {
  hl_data_analysis a;
  for (int v = 0; v < COUNT; v++)
    values[v] = (float)(100 / (1 + exp((distance(v % N, v / N % N, v / N / N, 24, 24, 24) - 15) / 0.7)) +
                        10 * noise(v % N, v / N % N, v / N / N));
  for (int n = 0; n < hot; n++) values[(n * 10007 + 31) % COUNT] = 1e5f;
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_data_analyse(volume, &a, NULL), HL_OK);
  assert_int_equal(a.kind, HL_DATA_SURFACES);
  hl_volume_release(volume);
  return a.background + a.solid;
}

/* Ten hot voxels of 110,592 do not hide the object. */
static void hot_voxels_hide_no_objects(void **state) {
  (void)state;
  hl_context *context = make_context();
  const double without = solid_beside_hot_voxels(context, 0);
  assert_true(without > 35 && without < 65);
  assert_near(solid_beside_hot_voxels(context, 10), without, 2);
  hl_context_destroy(context);
}

/* In coarse grids, an edge absorbs more, so that the same matter is as opaque with fewer voxels. */
static void coarse_matter_is_as_opaque(void **state) {
  (void)state;
  hl_context *context = make_context();
  double large = opacity_of_ball(context, 22), small = opacity_of_ball(context, 11);
  assert_true(large > 0.7);
  /* the opacity of an edge half as long, from the opacity of a whole one */
  assert_true(fabs(1 - sqrt(1 - small) - large) < 0.05);
  hl_context_destroy(context);
}

/* Red divided by blue, of the colour of values that are surely the volume's matter. */
static double warmth(hl_context *context, double (*each)(int, int, int), double value) {
  hl_transfer_function f;
  double color[3];
  fill(each);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  hl_transfer_function_color(&f, value, color);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  return color[0] / color[2];
}

static void skin_is_for_bodies(void **state) {
  (void)state;
  hl_context *context = make_context();
  assert_true(warmth(context, body, -400) > 1.8);
  assert_true(warmth(context, casting, 1500) < 1.5);
  assert_true(warmth(context, eight_bits, 1100 / 8.3) < 1.5);
  hl_context_destroy(context);
}

/* The common values of a flow are transparent, and its extremes are not. If all values are equally common,
 * all show. */
static void flows_show_their_extremes(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  fill(density);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  assert_true(hl_transfer_function_opacity(&f, 20) == 0);
  assert_true(hl_transfer_function_opacity(&f, volume->minimum) > 0.2 &&
              hl_transfer_function_opacity(&f, volume->maximum) > 0.2);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  fill(gradient);
  volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  for (double value = 301; value < 395; value += 5) {
    double opacity = hl_transfer_function_opacity(&f, value);
    /* half-transparent: an optical depth of 2 across 48 voxels */
    assert_true(opacity > 0.01 && opacity < 0.2);
  }
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* Each look makes a scene of each kind of volume, with its own function and shading. Unknown names are
 * refused with the nearest name. */
static void looks_by_name(void **state) {
  (void)state;
  static double (*const kinds[])(int, int, int) = {body, twigs, regions, mask, three};
  hl_context *context = make_context();
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_volume *volume = NULL;
  for (size_t n = 0; n < sizeof kinds / sizeof *kinds; n++) {
    fill(kinds[n]);
    volume = make_volume(context, N, values);
    for (size_t l = 0; hl_look_name(l) != NULL; l++) {
      assert_int_equal(hl_scene_for_volume_look(context, volume, NULL, hl_look_name(l), &scene, &error),
                       HL_OK);
      const hl_scene_volume *shown = &hl_scene_describe(scene)->volumes[0];
      hl_transfer_function f;
      hl_shading shading;
      assert_int_equal(hl_transfer_function_look(context, hl_look_name(l), volume, &f, &shading, &error),
                       HL_OK);
      assert_int_equal(shading, shown->shading);
      const bool labelled = (kinds[n] == regions || kinds[n] == mask) &&
                            l == 0; /* "auto" draws a label map by its labels, without a function */
      assert_true((shown->label_count > 0) == labelled);
      if (!labelled) {
        assert_int_equal(f.opacity_count, shown->transfer_function.opacity_count);
        assert_memory_equal(f.opacity, shown->transfer_function.opacity, f.opacity_count * sizeof *f.opacity);
      }
      bool seen = false;
      for (size_t p = 0; p < f.opacity_count; p++) seen = seen || f.opacity[p].opacity > 0;
      assert_true(seen);
      hl_transfer_function_release(context, &f);
      hl_scene_release(scene);
    }
    if (n + 1 < sizeof kinds / sizeof *kinds) hl_volume_release(volume);
  }
  assert_string_equal(hl_look_name(3), "xray");
  assert_int_equal(hl_scene_for_volume_look(context, volume, NULL, "xrya", &scene, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "xray"));
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* If the look that the data would get is named, the scene is the same. */
static void own_looks_by_name_change_nothing(void **state) {
  (void)state;
  static const struct {
    double (*each)(int, int, int);
    const char *look;
  } cases[] = {{puff, "smoke"}, {angiogram, "vessels"}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_scene *scenes[2] = {NULL, NULL};
    fill(cases[n].each);
    hl_volume *volume = make_volume(context, N, values);
    volume->says_fog = cases[n].each == puff;
    assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scenes[0], NULL), HL_OK);
    assert_int_equal(hl_scene_for_volume_look(context, volume, NULL, cases[n].look, &scenes[1], NULL), HL_OK);
    const hl_scene_description *a = hl_scene_describe(scenes[0]), *b = hl_scene_describe(scenes[1]);
    const hl_transfer_function *f = &a->volumes[0].transfer_function, *g = &b->volumes[0].transfer_function;
    assert_int_equal(f->opacity_count, g->opacity_count);
    assert_memory_equal(f->opacity, g->opacity, f->opacity_count * sizeof *f->opacity);
    assert_memory_equal(f->color, g->color, f->color_count * sizeof *f->color);
    assert_int_equal(a->light_count, b->light_count);
    for (size_t l = 0; l < a->light_count; l++) {
      assert_true(a->lights[l].intensity == b->lights[l].intensity);
      assert_memory_equal(a->lights[l].direction, b->lights[l].direction, sizeof a->lights[l].direction);
    }
    assert_true(a->sky.strength == b->sky.strength);
    hl_scene_release(scenes[0]);
    hl_scene_release(scenes[1]);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kinds_are_told_apart),
      cmocka_unit_test(fog_is_believed_where_the_data_may_be_fog),
      cmocka_unit_test(angiograms_show_vessels),
      cmocka_unit_test(strong_lobes_alone_are_seen),
      cmocka_unit_test(fields_show_a_core_through_a_shell),
      cmocka_unit_test(dark_skin_is_whole),
      cmocka_unit_test(cut_faces_tell_flesh_from_bone),
      cmocka_unit_test(cut_faces_tell_tissues),
      cmocka_unit_test(hot_voxels_hide_no_objects),
      cmocka_unit_test(coarse_matter_is_as_opaque),
      cmocka_unit_test(skin_is_for_bodies),
      cmocka_unit_test(flows_show_their_extremes),
      cmocka_unit_test(looks_by_name),
      cmocka_unit_test(own_looks_by_name_change_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
