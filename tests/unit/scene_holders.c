/* tests/unit/scene_holders.c - things that hold a scanned object are cut away, and nothing else is. Balls
 * beside boards, for which the answer is known. */
#include "core/memory.h"
#include "scene/geometry/cut.h"
#include "scene_parts.h"

enum { N = 64, COUNT = N * N * N };

static float values[COUNT];
static const double straight[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    turned[3][3] = {{0.4, 0.3, 0}, {-0.6, 0.8, 0}, {0, 0, 1.5}};

static double noise(int i, int j, int k) { /* -0.5..0.5 */
  unsigned state = (unsigned)((k * N + j) * N + i) * 2654435761u;
  state = (state ^ (state >> 15)) * 2246822519u;
  return (double)((state ^ (state >> 13)) & 0xffff) / 65536 - 0.5;
}

static double from_middle(int i, int j, int k) { return hypot(hypot(i - 32, j - 32), k - 32); }

/* A board of lighter matter from one side of the grid to the other. */
static bool in_board(int i, int j, int k) {
  (void)i;
  return j >= 26 && j < 38 && k >= 4 && k < 6;
}

/* Noisy air around a ball of a radius of 21 voxels, with a denser core. */
static double ball(int i, int j, int k) {
  double r = from_middle(i, j, k);
  return 8 + 100 / (1 + exp((r - 21) / 0.6)) + 60 / (1 + exp((r - 11) / 0.6)) + 4 * noise(i, j, k);
}

static double on_board(int i, int j, int k) {
  return in_board(i, j, k) ? 80 + 4 * noise(i, j, k) : ball(i, j, k);
}

/* A board that does not reach the border, one of matter as dense as the core's, and one that the ball's foot
 * stands on. */
static double inside(int i, int j, int k) {
  return in_board(i, j, k) && i > 3 && i < 60 ? 80 + 4 * noise(i, j, k) : ball(i, j, k);
}
static double dense(int i, int j, int k) {
  return in_board(i, j, k) && j < 34 ? 168 + 4 * noise(i, j, k) : ball(i, j, k);
}
static double footed(int i, int j, int k) {
  bool foot = hypot(i - 32, j - 32) < 6 && k >= 5 && k < 20;
  return foot ? 108 + 4 * noise(i, j, k) : on_board(i, j, k);
}

/* A compact piece beside the ball that the border cuts, as dense as a board. */
static double with_piece(int i, int j, int k) {
  return hypot(hypot(i - 8, j - 8), k - 2) < 8 ? 80 + 4 * noise(i, j, k) : ball(i, j, k);
}

/* A slanted board two voxels thick, three voxels from the ball, and wider than it. */
static bool in_slanted_board(int i, int j, int k) {
  double along = 0.36 * (i - 32) + 0.18 * (j - 32) + 0.9154 * (k - 32);
  return along > -27 && along < -25 && abs(j - 32) < 18;
}
static double on_slanted_board(int i, int j, int k) {
  return in_slanted_board(i, j, k) ? 80 + 4 * noise(i, j, k) : ball(i, j, k);
}

/* A board below and a compact piece above. The board is a holder, and the piece is not. */
static bool in_upper_piece(int i, int j, int k) { return hypot(hypot(i - 8, j - 8), k - 58) < 8; }
static double on_board_with_piece(int i, int j, int k) {
  return in_upper_piece(i, j, k) ? 80 + 4 * noise(i, j, k) : on_board(i, j, k);
}

/* A board below, and one above that foam joins to the ball. The foam is so faint that it belongs to no body
 * at the second level of cells. */
static bool in_foamed_board(int i, int j, int k) {
  (void)i;
  return j >= 26 && j < 38 && k >= 58 && k < 60;
}
static double between_boards(int i, int j, int k) {
  const bool foam = hypot(i - 32, j - 32) < 6 && k >= 32 && k < 58;
  if (in_foamed_board(i, j, k)) return 80 + 4 * noise(i, j, k);
  return foam ? fmax(45, on_board(i, j, k)) : on_board(i, j, k);
}

/* A board below, and 16 crumbs of 5 x 5 x 5 voxels in a ring around the ball. A plane that touches the ball's
 * hull cuts off one or two of them. */
static bool in_crumb(int i, int j, int k) {
  bool in = false;
  for (int n = 0; n < 16 && !in; n++) {
    const double angle = 0.3 + 2 * HL_PI * n / 16;
    in = abs(i - (int)(32 + 28 * cos(angle))) < 3 && abs(j - (int)(32 + 28 * sin(angle))) < 3 &&
         abs(k - 32) < 3;
  }
  return in;
}
static double on_board_with_crumbs(int i, int j, int k) {
  return in_crumb(i, j, k) ? 80 + 4 * noise(i, j, k) : on_board(i, j, k);
}

/* axes: hl_volume_description's. */
static hl_scene *make_scene(hl_context *context, double (*each)(int i, int j, int k),
                            const double axes[3][3]) {
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  for (int v = 0; v < COUNT; v++) values[v] = (float)each(v % N, v / N % N, v / N / N);
  for (int a = 0; a < 3; a++) d.origin[a] = 10 * a - 7;
  memcpy(d.axis, axes, sizeof d.axis);
  hl_volume *volume = create_volume(context, &d);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  hl_volume_release(volume);
  return scene;
}

/* The number of voxels of a body, and the number of them that no plane cuts off. */
typedef struct counts {
  int all, left;
} counts;

/* Counts the voxels of a body. No voxel of the ball, and no voxel beside it, is cut off. */
static counts count_left(hl_context *context, const hl_scene_volume *volume,
                         bool (*in)(int i, int j, int k)) {
  cut_shape *cuts;
  counts found = {0, 0};
  assert_int_equal(hl_cut_shapes(context, volume, &cuts, NULL), HL_OK);
  for (int v = 0; v < COUNT; v++) {
    int i = v % N, j = v / N % N, k = v / N / N;
    bool stays = hl_cuts_leave(cuts, volume->cut_count, (vec3){i, j, k});
    if (from_middle(i, j, k) < 22) assert_true(stays);
    if (!in(i, j, k)) continue;
    found.all++;
    found.left += stays;
  }
  hl_release(context, cuts);
  return found;
}

/* All of the board is cut away except for the part within two cells of the ball's hull, wherever the grid
 * lies and however it is turned. */
static void boards_are_cut_away(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int turn = 0; turn < 2; turn++) {
    hl_scene *scene = make_scene(context, on_board, turn ? turned : straight);
    const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
    assert_true(volume->cut_count > 0 && volume->cut_count <= 8);
    counts board = count_left(context, volume, in_board);
    assert_true(board.all == 12 * 2 * N && board.left * 100 <= board.all);
    hl_scene_release(scene);
  }
  hl_context_destroy(context);
}

/* A plane parallel to a slanted board cuts off all of it, and nothing else. */
static void one_plane_cuts_a_board_off(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, on_slanted_board, straight);
  const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
  counts board = count_left(context, volume, in_slanted_board);
  assert_true(board.all > 3000);
  assert_int_equal(board.left, 0);
  assert_int_equal(volume->cut_count, 1);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* A board that foam joins to the object goes, although a free board was found before it. */
static void both_boards_are_cut_away(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, between_boards, straight);
  const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
  const counts below = count_left(context, volume, in_board),
               above = count_left(context, volume, in_foamed_board);
  assert_int_equal(above.all, 12 * 2 * N);
  assert_true(below.left * 100 <= below.all && above.left * 100 <= above.all);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* Crumbs all around the object go with its holder, although each plane cuts off only a few of them. */
static void crumbs_go_with_the_board(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, on_board_with_crumbs, straight);
  const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
  counts board = count_left(context, volume, in_board), crumbs = count_left(context, volume, in_crumb);
  assert_true(board.left * 100 <= board.all);
  assert_int_equal(crumbs.all, 16 * 125);
  assert_true(crumbs.left * 100 <= crumbs.all);
  assert_true(volume->cut_count <= 24);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* Planes that cut off a holder cut nothing off a body that is no holder. */
static void planes_spare_other_bodies(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = make_scene(context, on_board_with_piece, straight);
  const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
  counts board = count_left(context, volume, in_board), piece = count_left(context, volume, in_upper_piece);
  assert_true(board.left * 100 <= board.all);
  assert_true(piece.all > 1500);
  assert_int_equal(piece.left, piece.all);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

static void other_bodies_stay(void **state) {
  (void)state;
  double (*const each[])(int i, int j, int k) = {ball, inside, dense, footed, with_piece};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof each / sizeof *each; n++) {
    hl_scene *scene = make_scene(context, each[n], straight);
    if (hl_scene_describe(scene)->volumes[0].cut_count != 0) fail_msg("volume %zu is cut", n);
    hl_scene_release(scene);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boards_are_cut_away),        cmocka_unit_test(both_boards_are_cut_away),
      cmocka_unit_test(one_plane_cuts_a_board_off), cmocka_unit_test(planes_spare_other_bodies),
      cmocka_unit_test(crumbs_go_with_the_board),   cmocka_unit_test(other_bodies_stay)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
