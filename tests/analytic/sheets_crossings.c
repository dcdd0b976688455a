/* analytic/sheets_crossings.c - meshes that cut through each other: the line between them is antialiased. */
#include <stdlib.h>

#include "../asserts.h"
#include "mesh_stage.h"
#include "surface/sample_rows.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };

/* A line through (x0, y0) that divides the picture. Its normal points to the side that is in front. */
typedef struct line {
  double nx, ny, x0, y0;
} line;

/* Returns the distance by which a point lies in front of the line, in world units. column, row: in pixels,
 * which are half a unit wide. */
static double ahead_of(const line *line, double column, double row) {
  return line->nx * ((column - SIDE / 2) * 0.5 - line->x0) + line->ny * ((SIDE / 2 - row) * 0.5 - line->y0);
}

/* Returns the fraction of the square [0, 1]^2 in which a x + b y > c. a, b: not negative. The area below the
 * line is a triangle without its parts beyond the square. */
static double fraction_beyond(double a, double b, double c) {
  if (a < 1e-9 || b < 1e-9) return fmin(fmax(1 - c / (a + b), 0), 1);
  double below = fmax(c, 0) * fmax(c, 0) - fmax(c - a, 0) * fmax(c - a, 0) - fmax(c - b, 0) * fmax(c - b, 0) +
                 fmax(c - a - b, 0) * fmax(c - a - b, 0);
  return 1 - below / (2 * a * b);
}

/* Returns the fraction of a pixel that lies in front of a line. */
static double fraction_of_pixel(const line *line, int x, int y) {
  return fraction_beyond(fabs(line->nx) * 0.5, fabs(line->ny) * 0.5,
                         -ahead_of(line, x + (line->nx < 0), y + (line->ny > 0)));
}

/* Returns the distance from a line, in world units, within which rounding decides on which side of the line a
 * sample lies. Corners of triangles are rounded to a grid of 1/256 of a pixel. The corners of boards of two
 * triangles lie on this grid exactly. */
static double doubt(int fine) { return fine > 1 ? 3e-3 : 1e-4; }

/* Returns the fraction of the pixel's sixteen samples that lie in front of a line. *sure: whether all samples
 * are farther from the line than `doubt`. */
static double fraction_of_samples(const line *line, int x, int y, double doubt, bool *sure) {
  double count = 0;
  *sure = true;
  for (int s = 0; s < 16; s++) {
    double ahead = ahead_of(line, x + (s + 0.5) / 16, y + (SAMPLE_ROWS[s] + 0.5) / 16);
    count += ahead > 0;
    *sure = *sure && fabs(ahead) > doubt;
  }
  return count / 16;
}

/* Adds a board of n by n squares, each of two triangles, through a point. by_x, by_y: the slopes of the
 * board's height. */
static hl_scene_mesh *add_board(mesh_stage *all, int n, vec3 at, double by_x, double by_y) {
  size_t vertices = (size_t)(n + 1) * (size_t)(n + 1), count = 2 * (size_t)n * (size_t)n;
  float(*positions)[3] = malloc(vertices * sizeof *positions);
  uint32_t(*triangles)[3] = malloc(count * sizeof *triangles);
  assert_non_null(positions);
  assert_non_null(triangles);
  for (size_t i = 0; i < vertices; i++) {
    double x = 26.0 * (double)(i % (size_t)(n + 1)) / n - 13,
           y = 26.0 * (double)(i / (size_t)(n + 1)) / n - 13;
    vec3_store(positions[i], (vec3){x, y, at.z + by_x * (x - at.x) + by_y * (y - at.y)});
  }
  for (size_t i = 0; i < count / 2; i++) {
    uint32_t from = (uint32_t)(i / (size_t)n * (size_t)(n + 1) + i % (size_t)n),
             next = from + (uint32_t)n + 1;
    const uint32_t corners[6] = {from, from + 1, next + 1, from, next + 1, next};
    for (int k = 0; k < 6; k++) triangles[2 * i + (size_t)k / 3][k % 3] = corners[k];
  }
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = vertices;
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = count;
  hl_scene_mesh *mesh = mesh_stage_describe(all, &d);
  free(positions);
  free(triangles);
  mesh->material = (hl_material){.emission = 1};
  return mesh;
}

/* A white and a black board cross in a line at an angle. Each pixel shows the fractions on the two sides of
 * the line. The boards are opaque or translucent, of large or small triangles, and sheets go from front to
 * back or back to front. */
static void test_two_boards(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 24; k++) {
    int fine = k % 2 ? 60 : 1;
    double opacity = k / 2 % 3 == 0 ? 1 : k / 2 % 3 == 1 ? 0.5 : 0.8, angle = 0.3 + 0.83 * k;
    double nx = cos(angle), ny = sin(angle), steep = k % 4 < 2 ? 0.4 : 0.9;
    vec3 at = {0.21, -0.37, 1};
    const line line = {nx, ny, at.x, at.y};
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    hl_scene_mesh *white = add_board(&all, fine, at, steep * nx, steep * ny),
                  *black = add_board(&all, fine, at, -0.2 * nx, -0.2 * ny);
    white->opacity = k / 2 % 3 == 2 ? 1 : opacity;
    black->opacity = opacity;
    for (int c = 0; c < 3; c++) black->color[c] = 0;
    stage_add_directional(&all.set, k < 12 ? (vec3){0.2, 0.3, -1} : (vec3){0.2, 0.3, 1});
    stage_render_sheets(&all.set, pixels);
    double first = white->opacity, behind = (1 - black->opacity) * white->opacity, sum = 0, expected_sum = 0,
           squares = 0;
    int crossed = 0;
    for (int i = 0; i < PIXELS; i++) {
      int x = i % SIDE, y = i / SIDE;
      if (x < 8 || y < 8 || x >= SIDE - 8 || y >= SIDE - 8) continue;
      bool sure;
      double front = fraction_of_pixel(&line, x, y),
             samples = fraction_of_samples(&line, x, y, doubt(fine), &sure),
             expected = front * first + (1 - front) * behind;
      if (sure) assert_near((double)pixels[4 * i], samples * first + (1 - samples) * behind, 1e-4);
      assert_near((double)pixels[4 * i + 3], 1 - (1 - white->opacity) * (1 - black->opacity), 1e-4);
      sum += (double)pixels[4 * i];
      expected_sum += expected;
      if (front <= 0 || front >= 1) continue;
      double off = ((double)pixels[4 * i] - expected) / (first - behind);
      squares += off * off;
      crossed++;
    }
    assert_true(crossed > 40);
    /* a line with stairs would have an error of 0.25 or more */
    assert_near(sqrt(squares / crossed), 0, 0.06);
    assert_near(sum, expected_sum, 1.5);
    mesh_stage_close(&all);
  }
}

/* Computes the colour of a sample of three boards, each of which has one channel. The boards are composited
 * in the order of their heights at the sample. */
static void composite_boards(const double height[3], const double opacity[3], double color[3]) {
  double left = 1;
  bool done[3] = {false, false, false};
  for (int c = 0; c < 3; c++) color[c] = 0;
  for (int n = 0; n < 3; n++) {
    int top = -1;
    for (int i = 0; i < 3; i++)
      if (!done[i] && (top < 0 || height[i] > height[top])) top = i;
    done[top] = true;
    color[top] += left * opacity[top];
    left *= 1 - opacity[top];
  }
}

/* A red, a green and a blue board cross each other in pairs, and all three in one pixel. Each pixel is the
 * mean of its samples, and each sample is composited in its own order. */
static void test_three_boards(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double opacities[4][3] = {{1, 1, 1}, {0.5, 1, 0.7}, {0.4, 0.6, 1}, {0.5, 0.6, 0.7}};
  for (int k = 0; k < 16; k++) {
    vec3 at = {0.21, -0.37, 1};
    const double *opacity = opacities[k / 2 % 4];
    int translucent = 0, fine = k % 2 ? 40 : 1;
    double by[3][2];
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    for (int i = 0; i < 3; i++) {
      double angle = 0.4 + 2.1 * i + 0.3 * k;
      by[i][0] = 0.5 * cos(angle), by[i][1] = 0.5 * sin(angle);
      hl_scene_mesh *mesh = add_board(&all, fine, at, by[i][0], by[i][1]);
      mesh->opacity = opacity[i];
      translucent += opacity[i] < 1;
      for (int c = 0; c < 3; c++) mesh->color[c] = c == i;
    }
    stage_add_directional(&all.set, k < 8 ? (vec3){0.2, 0.3, -1} : (vec3){0.2, 0.3, 1});
    stage_render_sheets(&all.set, pixels);
    int last = 0;
    for (int i = 0; i < PIXELS; i++) {
      int x = i % SIDE, y = i / SIDE;
      double expected[3] = {0, 0, 0}, near = 1;
      if (x < 12 || y < 12 || x >= SIDE - 12 || y >= SIDE - 12) continue;
      for (int s = 0; s < 16; s++) {
        double right = (x + (s + 0.5) / 16 - SIDE / 2) * 0.5 - at.x,
               up = (SIDE / 2 - y - (SAMPLE_ROWS[s] + 0.5) / 16) * 0.5 - at.y, height[3], color[3];
        for (int b = 0; b < 3; b++) height[b] = by[b][0] * right + by[b][1] * up;
        for (int b = 0; b < 3; b++) near = fmin(near, fabs(height[b] - height[(b + 1) % 3]));
        composite_boards(height, opacity, color);
        for (int c = 0; c < 3; c++) expected[c] += color[c] / 16;
      }
      bool all_cross = fabs(x + 0.5 - SIDE / 2 - 2 * at.x) < 1 && fabs(SIDE / 2 - y - 0.5 - 2 * at.y) < 1;
      if (near < doubt(fine) / 2 || (all_cross && translucent > 1)) continue;
      for (int c = 0; c < 3; c++) assert_near((double)pixels[4 * i + c], expected[c], 1e-4);
      last = i;
    }
    assert_true(last > 0);
    mesh_stage_close(&all);
  }
}

/* A white and a black triangle lie in one plane along the sheets. The fragments of the triangles have the
 * same height. Each pixel at the triangles' common edge is divided by its samples, wherever the sheets
 * begin. */
static void test_one_height(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const float positions[4][3] = {{-13, -12, 1}, {13, -12, 1}, {13, 10, 1}, {-13, 10, 1}};
  static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  static const float colors[2][4] = {{1, 1, 1, 1}, {0, 0, 0, 1}};
  const line line = {22, -26, -13, -12};
  for (int k = 0; k < 2; k++) {
    hl_mesh_description d;
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    hl_mesh_description_defaults(&d);
    d.positions = positions, d.vertex_count = 4;
    d.triangles = triangles, d.face_colors = colors, d.triangle_count = 2;
    mesh_stage_describe(&all, &d)->material = (hl_material){.emission = 1};
    stage_add_directional(&all.set, (vec3){0, 0, k ? 1 : -1});
    stage_render_sheets(&all.set, pixels);
    int shared = 0;
    for (int i = 0; i < PIXELS; i++) {
      int x = i % SIDE, y = i / SIDE;
      bool sure;
      double white = fraction_of_samples(&line, x, y, doubt(1), &sure);
      if (x < 8 || y < 14 || x >= SIDE - 8 || y >= SIDE - 10 || !sure) continue;
      assert_near((double)pixels[4 * i], white, 1e-4);
      shared += white > 0 && white < 1;
    }
    assert_true(shared > 30);
    mesh_stage_close(&all);
  }
}

/* A black board hangs from the edge of a white one, nearly along the view's rays. The black board's corners
 * in the picture are rounded, so that the black board may cover samples of the white board. At such samples
 * the black board counts as behind the white board, whatever height its extended plane has there. The white
 * board's edge lies on the grid to which corners are rounded. */
static void test_fold(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const uint32_t triangles[4][3] = {{0, 1, 2}, {1, 3, 2}, {0, 1, 4}, {1, 5, 4}};
  static const float colors[4][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}};
  for (int k = 0; k < 60; k++) {
    double angle = 0.2 + 1.7 * k, ends[2][2];
    for (int e = 0; e < 2; e++) {
      ends[e][0] = round((0.13 * k - 3 - (e ? 7 : -7) * sin(angle)) * 512) / 512;
      ends[e][1] = round((0.37 + (e ? 7 : -7) * cos(angle)) * 512) / 512;
    }
    double length = hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
    const line line = {(ends[1][1] - ends[0][1]) / length, (ends[0][0] - ends[1][0]) / length, ends[0][0],
                       ends[0][1]};
    float positions[6][3];
    for (int i = 0; i < 6; i++) {
      double aside = i / 2 == 1 ? 7 : i / 2 == 2 ? -1e-4 : 0, along = i / 2 == 2 ? 0.3 * sin(i + 2.3 * k) : 0;
      vec3_store(positions[i], (vec3){ends[i % 2][0] + line.nx * aside - line.ny * along,
                                      ends[i % 2][1] + line.ny * aside + line.nx * along, 2 - i / 2 * 2.5});
    }
    hl_mesh_description d;
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    hl_mesh_description_defaults(&d);
    d.positions = (const float(*)[3])positions, d.vertex_count = 6;
    d.triangles = triangles, d.face_colors = colors, d.triangle_count = 4;
    mesh_stage_describe(&all, &d)->material = (hl_material){.emission = 1};
    stage_add_directional(&all.set, (vec3){0.2, 0.3, k % 2 ? -1 : 1});
    stage_render_sheets(&all.set, pixels);
    int shared = 0;
    for (int i = 0; i < PIXELS; i++) {
      int x = i % SIDE, y = i / SIDE;
      double right = (x + 0.5 - SIDE / 2) * 0.5 - line.x0, up = (SIDE / 2 - y - 0.5) * 0.5 - line.y0,
             along = line.nx * up - line.ny * right;
      bool sure;
      double white = fraction_of_samples(&line, x, y, 1e-9, &sure);
      if (!sure || white == 0 || white == 1 || along < 1 || along > 13) continue;
      assert_near((double)pixels[4 * i], white, 1e-4);
      shared++;
    }
    assert_true(shared > 15);
    mesh_stage_close(&all);
  }
}

/* A sphere that is sunk into a board shows a disk. */
static void test_sphere_in_board(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const float sphere[1][4] = {{0.3f, -0.2f, 0, 8}};
  for (int k = 0; k < 4; k++) {
    double height = 2 + k, radius = sqrt(64 - height * height), sum = 0;
    hl_mesh_description d;
    mesh_stage all;
    mesh_stage_open(&all, SIDE, 32);
    hl_mesh_description_defaults(&d);
    d.spheres = sphere, d.sphere_count = 1;
    mesh_stage_describe(&all, &d)->material = (hl_material){.emission = 1};
    hl_scene_mesh *board = add_board(&all, k % 2 ? 40 : 1, (vec3){0, 0, height}, 0, 0);
    for (int c = 0; c < 3; c++) board->color[c] = 0;
    stage_add_directional(&all.set, k < 2 ? (vec3){0.2, 0.3, -1} : (vec3){0.2, 0.3, 1});
    stage_render_sheets(&all.set, pixels);
    for (int i = 0; i < PIXELS; i++) {
      double x = (i % SIDE + 0.5 - SIDE / 2) * 0.5 - 0.3, y = (SIDE / 2 - 0.5 - i / SIDE) * 0.5 + 0.2;
      double inside = (radius - sqrt(x * x + y * y)) / 0.5; /* pixels */
      sum += (double)pixels[4 * i];
      if (fabs(inside) > 0.75) assert_near((double)pixels[4 * i], inside > 0, 1e-4);
      else assert_near((double)pixels[4 * i], fmin(fmax(inside + 0.5, 0), 1), 0.25);
    }
    assert_near(sum * 0.25, HL_PI * radius * radius, 0.7);
    mesh_stage_close(&all);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_two_boards), cmocka_unit_test(test_three_boards),
                                     cmocka_unit_test(test_one_height), cmocka_unit_test(test_fold),
                                     cmocka_unit_test(test_sphere_in_board)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
