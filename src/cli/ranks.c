/* cli/ranks.c - see ranks.h. */
#define _GNU_SOURCE
#include "ranks.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "message.h"
#include "text/hash.h"

/* The known launchers: the launcher of Open MPI; the launcher of MPICH, Intel MPI and MVAPICH; and Slurm's
 * srun, which starts processes of either kind. */
static const launcher launchers[] = {
    {.rank_name = "OMPI_COMM_WORLD_RANK", .size_name = "OMPI_COMM_WORLD_SIZE", .mpi = HL_MPI_OPEN_MPI},
    {.rank_name = "PMI_RANK", .size_name = "PMI_SIZE", .mpi = HL_MPI_MPICH},
    {.rank_name = "SLURM_PROCID", .size_name = "SLURM_NTASKS", .mpi = HL_MPI_AUTO}};

bool launcher_of_process(launcher *found) {
  for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++) {
    *found = launchers[i];
    found->rank = getenv(found->rank_name);
    found->size = getenv(found->size_name);
    if (found->rank != NULL && found->size != NULL) return true;
  }
  return false;
}

hl_mpi launcher_mpi(void) {
  launcher found;
  return launcher_of_process(&found) ? found.mpi : HL_MPI_AUTO;
}

/* ---- waiting for the others to join ---- */

/* A process waits in hl_ranks_join() until all processes of its launcher have joined. A process whose command
 * line lacks the option never joins. MPICH's launcher does not end such a job, so that the others would wait
 * without end. A thread therefore ends the process when the wait is too long. */
static struct {
  long seconds;
  int exit_code;
  const char *option; /* for a line of error, or null if an error was told before */
  atomic_bool over;   /* whether the wait is over */
} join_wait;

/* Sets the longest wait: HALFLIGHT_JOIN_SECONDS, or else five minutes. Returns false if the variable is no
 * number of seconds; the wait is five minutes then, too. */
static bool limit_wait(void) {
  enum { SECONDS = 300 };
  const char *named = getenv("HALFLIGHT_JOIN_SECONDS");
  char *end = NULL;
  join_wait.seconds = SECONDS;
  if (named == NULL || named[0] == '\0') return true;
  long seconds = strtol(named, &end, 10);
  if (*end != '\0' || seconds <= 0) return false;
  join_wait.seconds = seconds;
  return true;
}

static void *stop_waiting(void *unused) {
  struct timespec left = {.tv_sec = join_wait.seconds};
  while (nanosleep(&left, &left) != 0) continue; /* a signal ends the sleep early */
  if (atomic_load(&join_wait.over)) return unused;
  if (join_wait.option != NULL)
    fail(join_wait.exit_code, "--%s: not all processes have joined within %ld seconds: give all of them --%s",
         join_wait.option, join_wait.seconds, join_wait.option);
  _exit(join_wait.exit_code);
}

/* Joins the other processes. Ends this process if they do not all join in time. If the system starts no
 * thread, the wait has no limit. option: for a line of error, or null. */
static hl_status join_in_time(hl_context *context, const char *option, int exit_code, hl_ranks **ranks,
                              hl_error *error) {
  pthread_t clock;
  join_wait.option = option;
  join_wait.exit_code = exit_code;
  atomic_store(&join_wait.over, false);
  if (pthread_create(&clock, NULL, stop_waiting, NULL) == 0) pthread_detach(clock);
  hl_status status = hl_ranks_join(context, NULL, ranks, error);
  atomic_store(&join_wait.over, true);
  return status;
}

static bool joined; /* whether ranks_begin() has joined the other processes */

int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks) {
  hl_error error = {0};
  launcher found;
  if (!launcher_of_process(&found) || found.mpi == HL_MPI_AUTO)
    return fail(EXIT_CODE_USAGE, "--%s: mpirun has not started this process: start it so", option);
  if (!limit_wait())
    return fail(EXIT_CODE_USAGE, "HALFLIGHT_JOIN_SECONDS must be a whole number of seconds above 0");
  if (join_in_time(host->context, option, EXIT_CODE_FAILURE, ranks, &error) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--%s: %s", option, error.message);
  joined = true;
  if (atoi(found.size) != hl_ranks_size(*ranks))
    return fail(
        EXIT_CODE_FAILURE,
        "--%s: %s is %s, but MPI's processes are %d: the library and the launcher belong to different MPIs",
        option, found.size_name, found.size, hl_ranks_size(*ranks));
  /* What processes do together depends on the option and on the version. */
  int other = hl_ranks_compare(*ranks, hl_hash_bytes(hl_hash_bytes(HL_HASH_BEGIN, option, strlen(option)),
                                                     hl_version(), strlen(hl_version())));
  if (other != 0)
    return fail(EXIT_CODE_USAGE, "--%s: rank %d has another option or another version than rank 0", option,
                other);
  host->quiet = host->quiet || hl_ranks_rank(*ranks) > 0;
  host->bar = host->bar && !host->quiet;
  return EXIT_CODE_OK;
}

/* ---- tests that all ranks make the same picture ---- */

/* Adds a scene's text without the names of files, which may differ from machine to machine. */
static uint64_t add_text(uint64_t hash, const char *text) {
  static const char key[] = "\"file\": \"";
  for (const char *name; (name = strstr(text, key)) != NULL;) {
    hash = hl_hash_bytes(hash, text, (size_t)(name - text));
    text = name + sizeof key - 1;
    while (*text != '\0' && *text != '"') text += text[0] == '\\' && text[1] != '\0' ? 2 : 1;
  }
  return hl_hash_bytes(hash, text, strlen(text));
}

/* Adds the facts that are known about all voxels of a volume. */
static uint64_t add_volume(uint64_t hash, const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (volume == NULL || hl_volume_get_info(volume, &info) != HL_OK) return hash;
  hash = hl_hash_bytes(hash, info.dimensions, sizeof info.dimensions);
  hash = hl_hash_bytes(hash, info.range, sizeof info.range);
  hash = hl_hash_bytes(hash, &info.mean, sizeof info.mean);
  return hl_hash_bytes(hash, info.histogram, sizeof info.histogram);
}

/* Sets *hash to a number for the picture of a scene. */
static hl_status number_scene(hl_context *context, const hl_scene *scene, uint64_t *hash, hl_error *error) {
  const hl_scene_description *description = hl_scene_describe(scene);
  char *text = NULL;
  hl_status status = hl_scene_to_json(context, scene, &text, error);
  if (status != HL_OK) return status;
  *hash = add_text(HL_HASH_BEGIN, text);
  for (size_t v = 0; v < description->volume_count; v++) {
    *hash = add_volume(*hash, description->volumes[v].volume);
    *hash = add_volume(*hash, description->volumes[v].mask.volume);
  }
  hl_text_release(context, text);
  return HL_OK;
}

int ranks_compare(cli_host *host, hl_ranks *ranks, const hl_scene *scene) {
  uint64_t hash = 0;
  hl_error error = {0};
  if (ranks == NULL) return EXIT_CODE_OK;
  hl_status status = number_scene(host->context, scene, &hash, &error);
  if (status != HL_OK) return host_fail(host, PHASE_RUN, status, &error);
  int other = hl_ranks_compare(ranks, hash);
  if (other == 0) return EXIT_CODE_OK;
  return fail(
      EXIT_CODE_INPUT,
      "rank %d has another scene or other voxels than rank 0: give all processes the same options and "
      "equal files",
      other);
}

void ranks_check(hl_ranks *ranks, int exit_code) {
  if (ranks == NULL || exit_code == EXIT_CODE_OK) return;
  if (exit_code != EXIT_CODE_INTERRUPTED)
    fail(exit_code, "rank %d of %d has failed and ends them all", hl_ranks_rank(ranks), hl_ranks_size(ranks));
  hl_ranks_abort(ranks, exit_code);
}

/* ---- failing before the ranks have joined ---- */

/* The other processes may be no ranks, and may never join: this process waits for them no longer than they
 * would wait for it. */
void ranks_end_others(int exit_code) {
  hl_context_options options;
  hl_context *context = NULL;
  hl_ranks *ranks = NULL;
  if (joined || launcher_mpi() == HL_MPI_AUTO) return;
  limit_wait();
  hl_context_options_defaults(&options);
  options.mpi = launcher_mpi();
  if (hl_context_create(&options, &context, NULL) == HL_OK &&
      join_in_time(context, NULL, exit_code, &ranks, NULL) == HL_OK)
    ranks_check(ranks, exit_code);
  hl_ranks_leave(ranks);
  hl_context_destroy(context);
}
