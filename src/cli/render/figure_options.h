/* cli/render/figure_options.h - the rows of the group "Figure" in the table of options of `halflight render`.
 */
#ifndef HL_CLI_RENDER_FIGURE_OPTIONS_H
#define HL_CLI_RENDER_FIGURE_OPTIONS_H

#include "render.h"

static const cli_choice axes_choices[] = {
    {"arrows", HL_AXES_ARROWS}, {"letters", HL_AXES_LETTERS}, {NULL, 0}};

#define RENDER_FIGURE_OPTIONS                                                                                \
  [RENDER_WIDTH] =                                                                                           \
      {.name = "width",                                                                                      \
       .kind = OPTION_TEXT,                                                                                  \
       .argument = "LENGTH",                                                                                 \
       .group = "Figure",                                                                                    \
       .help =                                                                                               \
           "width on paper: 89mm, 8.9cm, 3.5in, 252pt; of --views\nof the whole sheet; without "             \
           "--size the picture has\nas many pixels as --dpi wants"},                                         \
  [RENDER_DPI] = {.name = "dpi",                                                                             \
                  .kind = OPTION_NUMBERS,                                                                    \
                  .argument = "N",                                                                           \
                  .help = "pixels an inch, which .png and .tif state\n(default 300, with --width)",          \
                  .count = 1,                                                                                \
                  .low = 1,                                                                                  \
                  .high = 10000},                                                                            \
  [RENDER_SCALE_BAR] = {.name = "scale-bar",                                                                 \
                        .kind = OPTION_TEXT,                                                                 \
                        .argument = "auto|LENGTH[@DEPTH]",                                                   \
                        .implied = "auto",                                                                   \
                        .help =                                                                              \
                            "a bar with its length, as 50um; in a perspective\npicture (not --ortho) "       \
                            "it holds at the target (@target)\nor at this distance from the eye"},           \
  [RENDER_UNIT] = {.name = "unit",                                                                           \
                   .kind = OPTION_TEXT,                                                                      \
                   .argument = "UNIT",                                                                       \
                   .help =                                                                                   \
                       "unit of lengths in the volumes' files, where these do\nnot tell it: mm, um, nm, "    \
                       "...; lengths with a unit, as\n--slice z=40mm, are converted to it"},                 \
  [RENDER_LEGEND] = {.name = "legend",                                                                       \
                     .kind = OPTION_TEXT,                                                                    \
                     .argument = "auto|TITLE",                                                               \
                     .implied = "auto",                                                                      \
                     .help =                                                                                 \
                         "colours and opacity over the values, or surfaces, or\nnames of labels; TITLE "     \
                         "as 'Density (g/cm3)'"},                                                            \
  [RENDER_AXES] =                                                                                            \
      {.name = "axes",                                                                                       \
       .kind = OPTION_CHOICE,                                                                                \
       .choices = axes_choices,                                                                              \
       .implied = "arrows",                                                                                  \
       .help = "arrows of the world's directions, or letters of the\nbody's directions at the edges"},       \
  [RENDER_MARKS] = {.name = "marks",                                                                         \
                    .kind = OPTION_SWITCH,                                                                   \
                    .help = "the scene's rulers, angles, lines, arrows and texts,\nwith what they measure"}, \
  [RENDER_ANNOTATE] = {.name = "annotate",                                                                   \
                       .kind = OPTION_TEXT,                                                                  \
                       .argument = "TEXT[@X,Y[,Z]]",                                                         \
                       .help =                                                                               \
                           "a text at fractions of the picture from its upper\nleft, or beside a point "     \
                           "X,Y,Z of the world, or at the\nupper left; in a "                                \
                           "series and in a film %d is the picture's\nnumber, and "                          \
                           "%s the name of a series' file; give the option\nagain for more texts",           \
                       .repeatable = true},                                                                  \
  [RENDER_PLACE] =                                                                                           \
      {.name = "place",                                                                                      \
       .kind = OPTION_TEXT,                                                                                  \
       .argument = "PART=CORNER",                                                                            \
       .help =                                                                                               \
           "a corner for the legend, the scale-bar or the axes, as\nlegend=upper-left "                      \
           "(default: where it covers the least);\nlegend=below: the legend in a strip below "               \
           "the picture, or\nbelow all pictures, as with --views; give the option again\nfor more "          \
           "parts",                                                                                          \
       .repeatable = true},                                                                                  \
  [RENDER_FONT_SIZE] = {                                                                                     \
      .name = "font-size",                                                                                   \
      .kind = OPTION_NUMBERS,                                                                                \
      .argument = "POINTS",                                                                                  \
      .help = "size of letters (default 7, in a picture 89 mm wide\nwhere --width and --dpi do not say it)", \
      .count = 1,                                                                                            \
      .low = 1,                                                                                              \
      .high = 200}

#endif
