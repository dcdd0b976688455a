/* tests/unit/figure_places.c - the places of the parts of an overlay: how much of the picture's matter a box
 * covers, and the boxes that cover the least. */
#include "../asserts.h"
#include "figure/places.h"
#include "image_parts.h"

/* The picture lies at (10, 20) on the page, so that a wrong origin is found. */
static const hl_rectangle page = {10, 20, 100, 100};

/* A picture that shows matter of one opacity from (left, top) to before (right, bottom). */
static hl_image *make_block(hl_context *context, int width, int height, const int from[2], const int to[2],
                            float opacity) {
  hl_image *image = make_image(context, width, height);
  for (int y = from[1]; y < to[1]; y++)
    for (int x = from[0]; x < to[0]; x++) hl_image_pixels(image)[4 * (y * width + x) + 3] = opacity;
  return image;
}

static hl_cover measure(hl_context *context, const hl_image *image) {
  hl_cover cover;
  assert_int_equal(hl_cover_measure(context, image, &cover, NULL), HL_OK);
  return cover;
}

/* The picture has 50 x 25 pixels. A pixel is 2 x 4 points large. Codes of opacity have 8 bits. */
static void a_box_sums_its_pixels(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_block(context, 50, 25, (int[2]){10, 5}, (int[2]){20, 10}, 0.4f);
  hl_cover cover = measure(context, image);
  assert_near(hl_cover_in(&cover, page, page), 50 * 8 * 0.4, 1e-9);
  /* the box covers four pixels of the block's upper left corner, which lies at (30, 40) on the page */
  assert_near(hl_cover_in(&cover, page, (hl_rectangle){26, 36, 8, 12}), 4 * 8 * 0.4, 1e-9);
  /* a box that touches parts of pixels covers the whole pixels */
  assert_near(hl_cover_in(&cover, page, (hl_rectangle){29, 39, 1.5, 1.5}), 1 * 8 * 0.4, 1e-9);
  assert_true(hl_cover_in(&cover, page, (hl_rectangle){20, 20, 10, 20}) == 0);
  /* parts of a box beyond the picture cover nothing */
  assert_near(hl_cover_in(&cover, page, (hl_rectangle){-500, -500, 1000, 1000}), 50 * 8 * 0.4, 1e-9);
  hl_cover_release(&cover);
  hl_image_destroy(image);
  /* an opacity below half of a code does not count */
  image = make_block(context, 50, 25, (int[2]){0, 0}, (int[2]){50, 25}, 0.0019f);
  cover = measure(context, image);
  assert_true(hl_cover_in(&cover, page, page) == 0);
  hl_cover_release(&cover);
  hl_image_destroy(image);
  cover = measure(context, NULL);
  assert_true(hl_cover_in(&cover, page, page) == 0);
  hl_cover_release(&cover);
  end_context(context);
}

/* A large picture is searched in cells of several pixels, also if they do not fill its last column: 1030 x
 * 700 pixels have cells of 3 x 3. */
static void large_pictures_have_cells(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_block(context, 1030, 700, (int[2]){1029, 699}, (int[2]){1030, 700}, 1);
  hl_cover cover = measure(context, image);
  assert_int_equal(cover.columns, 344);
  assert_int_equal(cover.rows, 234);
  const hl_rectangle picture = {0, 0, 1030, 700};
  assert_near(hl_cover_in(&cover, picture, picture), 1, 1e-9);
  assert_near(hl_cover_in(&cover, picture, (hl_rectangle){1029.5, 699.5, 0.1, 0.1}), 1, 1e-9);
  assert_true(hl_cover_in(&cover, picture, (hl_rectangle){0, 0, 1029, 700}) == 0);
  hl_cover_release(&cover);
  hl_image_destroy(image);
  end_context(context);
}

/* Finds the best box along the edges for a box of 10 x 20 points, 5 points from the edges. The usual place is
 * the upper right. */
static hl_search search_in(const hl_cover *cover, const hl_taken *taken, double rim) {
  hl_search search = {.taken = taken, .cover = cover, .rim = rim, .unit = 10};
  hl_search_edges(&search, (hl_rectangle){95, 25, 10, 20}, 1);
  return search;
}

static void assert_box(const hl_search *search, double left, double top) {
  assert_true(search->found);
  assert_near(search->box.left, left, 1e-9);
  assert_near(search->box.top, top, 1e-9);
  assert_true(search->box.width == 10 && search->box.height == 20);
}

static hl_search search_over(const int from[2], const int to[2], float opacity, double rim) {
  hl_context *context = make_context();
  hl_image *image = make_block(context, 100, 100, from, to, opacity);
  hl_cover cover = measure(context, image);
  const hl_taken taken = {.picture = page};
  const hl_search search = search_in(&cover, &taken, rim);
  hl_cover_release(&cover);
  hl_image_destroy(image);
  end_context(context);
  return search;
}

static void parts_cover_the_least(void **state) {
  (void)state;
  const hl_taken taken = {.picture = page};
  const hl_cover nothing = {0};
  hl_search search = search_in(&nothing, &taken, 0);
  assert_box(&search, 95, 25); /* nothing is shown */
  search = search_over((int[2]){0, 0}, (int[2]){100, 100}, 1, 0);
  assert_box(&search, 95, 25); /* all places cover the same amount */
  assert_near(search.covered, 20, 1e-9);
  /* matter covers 40 x 50 points at the upper right; the way to the left is shorter than the way down */
  search = search_over((int[2]){60, 0}, (int[2]){100, 50}, 1, 0);
  assert_box(&search, 60, 25);
  assert_near(search.far, 35, 1e-9);
  assert_true(search.covered == 0);
  /* the box's rim does not touch the matter either */
  search = search_over((int[2]){60, 0}, (int[2]){100, 50}, 1, 3);
  assert_box(&search, 57, 25);
  /* matter is 80 points wide, so that the way down is shorter */
  search = search_over((int[2]){20, 0}, (int[2]){100, 50}, 1, 0);
  assert_box(&search, 95, 70);
  /* matter lies on all edges except at the lower left */
  search = search_over((int[2]){15, 0}, (int[2]){100, 100}, 1, 0);
  assert_box(&search, 15, 95 + 5 - 75);
}

/* Covered areas count in twentieths of the box, which is 10 points squared. A box that covers less by a
 * smaller part does not take the place of the usual one. */
static void a_little_moves_nothing(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_block(context, 100, 100, (int[2]){0, 0}, (int[2]){100, 100}, 1);
  for (int bare = 9; bare <= 11; bare++) {
    /* only the last box, at the lower left corner, has pixels without matter */
    for (int n = 0; n < bare; n++)
      hl_image_pixels(image)[4 * (94 * 100 + 5 + n % 10 - (n / 10) * 100) + 3] = 0;
    hl_cover cover = measure(context, image);
    const hl_taken taken = {.picture = page};
    hl_search search = search_in(&cover, &taken, 0);
    if (bare < 10) assert_box(&search, 95, 25);
    else assert_near(search.covered, 19, 1e-9);
    hl_cover_release(&cover);
  }
  hl_image_destroy(image);
  end_context(context);
}

static void parts_keep_clear_of_each_other(void **state) {
  (void)state;
  const hl_cover nothing = {0};
  hl_taken taken = {.picture = page};
  hl_take(&taken, (hl_rectangle){90, 20, 20, 31.25});
  hl_search search = search_in(&nothing, &taken, 2);
  assert_box(&search, 78, 25); /* except for its rim, the box touches the part on its right: 90 - 2 - 10 */
  hl_take(&taken, (hl_rectangle){10, 20, 80, 30});
  search = search_in(&nothing, &taken, 2);
  assert_box(&search, 95, 53.25);
  hl_take(&taken, (hl_rectangle){10, 51, 100, 69});
  search = search_in(&nothing, &taken, 2);
  assert_false(search.found);
  const hl_taken narrow = {.picture = {96, 20, 9, 100}}; /* the picture is narrower than the box */
  search = search_in(&nothing, &narrow, 0);
  assert_false(search.found);
}

static void free_heights(void **state) {
  (void)state;
  hl_taken taken = {.picture = page};
  const hl_rectangle column = {80, 22, 25, 96};
  assert_near(hl_free_height(&taken, column), 96, 1e-9);
  hl_take(&taken, (hl_rectangle){20, 20, 60, 100}); /* beside the column */
  assert_near(hl_free_height(&taken, column), 96, 1e-9);
  hl_take(&taken, (hl_rectangle){100, 60, 10, 20});
  assert_near(hl_free_height(&taken, column), 38, 1e-9);
  hl_take(&taken, (hl_rectangle){80, 20, 10, 10});
  /* the heights from 80 to 118 are free; above the new part only 30 are */
  assert_near(hl_free_height(&taken, column), 38, 1e-9);
  hl_take(&taken, (hl_rectangle){80, 100, 30, 5});
  assert_near(hl_free_height(&taken, column), 30, 1e-9);
  hl_take(&taken, (hl_rectangle){0, 0, 200, 200});
  assert_near(hl_free_height(&taken, column), 0, 1e-9);
}

static void corners_are_as_far_from_edges(void **state) {
  (void)state;
  const hl_rectangle box = {95, 25, 10, 20};
  hl_rectangle other = hl_rectangle_in_corner(box, page, true, false);
  assert_true(other.left == 15 && other.top == 25);
  other = hl_rectangle_in_corner(box, page, false, true);
  assert_true(other.left == 95 && other.top == 95);
  other = hl_rectangle_in_corner(box, page, false, false);
  assert_true(other.left == 95 && other.top == 25);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_sums_its_pixels),          cmocka_unit_test(large_pictures_have_cells),
      cmocka_unit_test(parts_cover_the_least),          cmocka_unit_test(a_little_moves_nothing),
      cmocka_unit_test(parts_keep_clear_of_each_other), cmocka_unit_test(free_heights),
      cmocka_unit_test(corners_are_as_far_from_edges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
