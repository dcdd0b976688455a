/* compose/shown_labels.h - "show": the labels of a label map that show, with their colours and opacities. */
#ifndef HL_COMPOSE_SHOWN_LABELS_H
#define HL_COMPOSE_SHOWN_LABELS_H

#include "compose/asked.h"

/* One of the labels that "show" names: NAME|NUMBER|all|rest[=COLOR][:OPACITY]. */
typedef struct hl_shown_label {
  char name[128], whole[128]; /* the name alone, and the whole text; the whole text may itself be the name of
                               * a label, with ":" or "=" in it */
  const char *wrong; /* an error's advice on how to mend the text, if it is no valid name; null: the text is
                      * valid */
  bool all;  /* the item stands for all labels that the list does not name: "all", and "rest" without a
              * mask */
  bool rest; /* the item is "rest"; with a mask it stands for what lies outside of the labels */
  bool colored, found;
  double color[3], opacity;
} hl_shown_label;

enum { HL_MOST_SHOWN = 512, HL_MOST_LABEL_LAYERS = 64 };

typedef struct hl_shown_list {
  hl_shown_label labels[HL_MOST_SHOWN];
  size_t count;
  bool of_mask; /* the labels are parts of a mask; else they are bodies of their own */
} hl_shown_list;

/* The layers of a label map's file as volumes. The structure owns their labels and voxels. */
typedef struct hl_label_layers {
  hl_scene_volume volumes[HL_MOST_LABEL_LAYERS];
  size_t count;
} hl_label_layers;

hl_status hl_read_shown(const hl_asked *show, hl_shown_list *list, hl_error *error);

/* Shows the labels that the list names. An empty list changes nothing. "all" shows every label except those
 * that a table hides. What the list says of a label by name or number counts more than "all", wherever it
 * stands in the list. */
void hl_show_labels(hl_shown_list *list, hl_label *labels, size_t count);

/* Logs how labels are named whose own names are "all" or "rest", where the list has these words. */
void hl_tell_of_shadowed_labels(hl_context *context, const hl_shown_list *list,
                                const hl_label_layers *layers);

/* Refuses names that no label of any layer has. The error suggests the nearest name, or lists all names. */
hl_status hl_check_shown(const hl_shown_list *list, const hl_label_layers *layers, hl_error *error);

#endif
