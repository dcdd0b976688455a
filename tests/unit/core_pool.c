/* unit/core_pool.c - runs and offers of the thread pool: every call is made once, and a run ends no sooner
 * than its calls. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <halflight/context.h>

#include "core/pool.h"

enum { MOST = 500, ROUNDS = 400 };

typedef struct calls {
  atomic_int made[MOST]; /* of each index */
} calls;

static void count_call(void *data, size_t index, int worker) {
  (void)worker;
  calls *calls = data;
  assert_true(index < MOST);
  atomic_fetch_add(&calls->made[index], 1);
}

static void assert_each_made(calls *calls, size_t count) {
  for (size_t i = 0; i < MOST; i++) assert_int_equal(atomic_exchange(&calls->made[i], 0), i < count);
}

typedef struct team {
  hl_context *context;
  hl_pool *pool;
} team;

static team team_of(int threads, const hl_context_options *options) {
  team team;
  assert_int_equal(hl_context_create(options, &team.context, NULL), HL_OK);
  assert_int_equal(hl_pool_create(team.context, threads, &team.pool, NULL), HL_OK);
  return team;
}

static void dismiss(team *team) {
  hl_pool_destroy(team->pool);
  assert_int_equal(hl_context_memory_held(team->context), 0);
  hl_context_destroy(team->context);
}

static void test_runs(void **state) {
  (void)state;
  static calls run;
  for (int threads = 1; threads <= 5; threads++) {
    team team = team_of(threads, NULL);
    for (size_t count = 0; count < MOST; count += 7) {
      hl_pool_run(team.pool, count, count_call, &run);
      assert_each_made(&run, count);
    }
    dismiss(&team);
  }
}

/* A run between an offer and the offer's end makes all its own calls before it returns. The end makes the
 * offer's calls. */
static void test_offers(void **state) {
  (void)state;
  static calls run, offered;
  for (int threads = 1; threads <= 5; threads++) {
    team team = team_of(threads, NULL);
    for (size_t round = 0; round < ROUNDS; round++) {
      size_t count = round * 31 % MOST;
      hl_pool_offer(team.pool, count, count_call, &offered);
      if (threads == 1) assert_each_made(&offered, count);
      for (size_t runs = 0; runs < round % 4; runs++) {
        hl_pool_run(team.pool, (round + runs * 13) % 40, count_call, &run);
        assert_each_made(&run, (round + runs * 13) % 40);
      }
      hl_pool_finish_offer(team.pool);
      if (threads > 1) assert_each_made(&offered, count);
      hl_pool_finish_offer(team.pool); /* without an offer, the end does nothing */
      assert_each_made(&offered, 0);
    }
    dismiss(&team);
  }
}

static int stop(void *user_data) { return *(const int *)user_data; }

/* A cancelled pool makes none of the calls. After hl_pool_resume() it works again. */
static void test_cancelled_offer(void **state) {
  (void)state;
  static calls offered;
  int stops = 1;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = &stops;
  options.cancelled = stop;
  team team = team_of(3, &options);
  assert_true(hl_pool_cancelled(team.pool));
  hl_pool_offer(team.pool, MOST, count_call, &offered);
  hl_pool_finish_offer(team.pool);
  assert_each_made(&offered, 0);
  stops = 0;
  hl_pool_resume(team.pool);
  hl_pool_offer(team.pool, MOST, count_call, &offered);
  hl_pool_finish_offer(team.pool);
  assert_each_made(&offered, MOST);
  dismiss(&team);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_runs),
      cmocka_unit_test(test_offers),
      cmocka_unit_test(test_cancelled_offer),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
