/* cli/render/series.h - declares the functions by which `halflight render` makes a series of pictures. */
#ifndef HL_CLI_RENDER_SERIES_H
#define HL_CLI_RENDER_SERIES_H

#include "film/film.h"
#include "render.h"

/* The progress of a series. */
typedef struct series_progress {
  int wanted;     /* number of pictures in this run's part of the series */
  int done;       /* number of pictures that exist */
  int rendered;   /* number of pictures that this run has rendered */
  int failed;     /* number of files that cannot be read */
  double seconds; /* for the rendered pictures */
} series_progress;

typedef struct series_job {
  cli_host host;
  cli_value values[RENDER_OPTION_COUNT]; /* whether --range is set by --range-of-all */
  const char *pattern; /* the pattern of OUT, with one %d for a number or one %s for the file's name */
  struct {
    char **names; /* owned; [count]: paths of volumes, or of meshes if there is no volume */
    int count;
    bool of_meshes; /* the files are meshes */
    bool of_times;  /* whether --time all was given: all names are the name of one file, and the numbers are
                     * its time steps */
    bool *bad;      /* owned; [count]; whether the file could not be read; its error line was printed then */
    int first;      /* the number of the file from which `scene` was made */
  } files;
  char *meshes[MAXIMUM_OPERANDS + 1]; /* borrowed; paths of meshes that are in every picture; ended by null */
  int mesh_count;
  int part, parts;
  series_progress progress;
  hl_scene *scene;                  /* owned; the scene that was made from the first file that can be read */
  char size_text[RENDER_SIZE_TEXT]; /* the text of --size, if --width sets it */
  cli_overlay overlay;              /* owned; drawn over each picture */
  const film_options *motion;       /* borrowed; the keys that change numbers of the scene from picture to
                                     * picture; null if nothing changes */
} series_job;

/* Returns true if the text has one word for a number (text/number_word.h), and no other '%' but "%%". */
bool series_has_number(const char *text);

/* Finds the files that the operands name. Files of the series are separated from files that are in every
 * picture. Call series_release_files() even after a failure. Returns the exit code. */
int series_find_files(series_job *job, char **operands);
void series_release_files(series_job *job);

/* Handles --time all: makes a series of all time steps of the only file, which must be a volume. Returns the
 * exit code. */
int series_find_times(series_job *job);

/* Reads a volume of the series. channel: HL_INDEX_DEFAULT means the channel that the options ask for. A
 * failure is printed once. Returns the exit code. */
int series_load_volume(series_job *job, int number, int channel, hl_volume **volume);

/* Makes the scene of a file: the scene of the first file, with the voxels or triangles of this file. After a
 * failure, job->files.bad[number] says whether the file is the cause. */
int series_scene(series_job *job, int number, hl_scene **scene);

/* Reads the volumes of a file's scene where its camera sees them (nearer.c). A failure is noted as
 * series_scene() notes it. */
int series_go_nearer(series_job *job, int number, hl_scene **scene);

/* Makes the scene of a file, but with the voxels or triangles of the first file, so that the file need not be
 * read. Only the scene's text is used, to find out whether a picture was made of this scene. Fails, without
 * an error line, for label maps, because their text depends on the file's content. */
hl_status series_scene_unread(const series_job *job, int number, hl_scene **scene);

#endif
