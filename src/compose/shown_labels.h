/* compose/shown_labels.h - applies the option "show", which chooses the visible labels of a label map, with
 * their colours and opacities. */
#ifndef HL_COMPOSE_SHOWN_LABELS_H
#define HL_COMPOSE_SHOWN_LABELS_H

#include "compose/asked.h"

/* An item of the list in the option "show": NAME|NUMBER|all|rest[=COLOR|=own][:OPACITY]. */
typedef struct hl_shown_label {
  char name[128], whole[128]; /* name: the item's name alone; whole: the item's whole text, which may itself
                               * be the name of a label that has ":" or "=" in it */
  const char *wrong; /* the advice, for an error, on how to correct the item; null if the item is valid */
  bool all;  /* whether the item stands for all labels that the list does not name: "all", and without a mask
              * also "rest" */
  bool rest; /* whether the item is "rest"; with a mask, "rest" stands for the matter outside of the labels */
  bool colored, found;
  bool own; /* whether the item asks for the label's own colour, by "=own" */
  double color[3], opacity;
} hl_shown_label;

enum { HL_MOST_SHOWN = 512, HL_MOST_LABEL_LAYERS = 64 };

typedef struct hl_shown_list {
  hl_shown_label labels[HL_MOST_SHOWN];
  size_t count;
  bool of_mask; /* whether the labels are parts of a mask; if not, they are bodies of their own */
} hl_shown_list;

/* The layers of a label map's file as volumes. The structure owns their labels and voxels. */
typedef struct hl_label_layers {
  hl_scene_volume volumes[HL_MOST_LABEL_LAYERS];
  size_t count;
  char stem[256]; /* the name of the only label, if the file gives the label no name */
} hl_label_layers;

hl_status hl_read_shown(const hl_asked *show, hl_shown_list *list, hl_error *error);

/* Makes the item "rest" stand for all labels that the list does not name, for a list that does not belong to
 * a mask. */
void hl_let_rest_be_all(hl_shown_list *list);

/* Shows the labels that the list names. An empty list changes nothing. The item "all" shows every label that
 * no table hides. For a label that another item names by its name or number, the other item counts, and not
 * "all". The order of the items has no effect. */
void hl_show_labels(hl_shown_list *list, hl_label *labels, size_t count);

/* If the list has the items "all" or "rest", logs how to name labels whose own names are these words. */
void hl_tell_of_shadowed_labels(hl_context *context, const hl_shown_list *list,
                                const hl_label_layers *layers);

/* Refuses names that no label of any layer has. The error suggests the nearest name, or lists all names. */
hl_status hl_check_shown(const hl_shown_list *list, const hl_label_layers *layers, hl_error *error);

#endif
