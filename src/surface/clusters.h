/* surface/clusters.h - clusters: up to 64 triangles, or spheres, of a mesh that lie beside each other, with a
 * box around them and a cone that holds their normals.
 *
 * What a view sees of primitives is asked once for each cluster where it can be. A cluster of triangles has
 * its own copy of their vertices, so that a view sees them without a search in memory. */
#ifndef HL_SURFACE_CLUSTERS_H
#define HL_SURFACE_CLUSTERS_H

#include "core/memory.h"
#include "surface/small_triangles.h"
#include "surface/surfaces.h"
#include "view/view.h"

enum { CLUSTER_SIZE = CLUSTER_TRIANGLES };

struct surface_cluster {
  float low[3], high[3]; /* of the box; frame space */
  float axis[3];         /* of the cone; unit */
  float cosine;          /* of the greatest angle between the axis and a normal; below 0: the normals may have
                            any direction */
  uint32_t first; /* of all->order: its primitives; the order keeps each kind's numbers together, so that
                     primitive `first` has the kind of all of them */
  uint16_t count, mesh;
  uint16_t vertices;   /* of triangles: as in cluster_shape */
  size_t first_vertex; /* in all->cluster_positions */
};

/* Counts what hl_clusters_create() takes at most: as if triangles shared their vertices with few others. */
void hl_clusters_count(const hl_scene_description *scene, hl_layout *layout);

/* Makes the clusters of all meshes, in the order of meshes, those of triangles first. */
hl_status hl_clusters_create(hl_context *context, hl_pool *pool, surfaces *all, hl_error *error);
void hl_clusters_release(hl_context *context, surfaces *all);

/* A cluster of triangles for the functions of small triangles; borrowed. */
static inline cluster_shape hl_cluster_shape(const surfaces *all, const surface_cluster *cluster) {
  size_t number = (size_t)(cluster - all->clusters);
  return (cluster_shape){all->cluster_positions + 3 * cluster->first_vertex, cluster->vertices,
                         all->cluster_corners[number], all->cluster_normals[number]};
}

/* The least height above the first sheet of a cluster's box. */
double hl_lowest_height(const sheet_stack *sheets, const surface_cluster *cluster);

/* Whether every triangle of a cluster turns its back to the view, by some degrees. False where it is not
 * known. */
bool hl_cluster_faces_away(const surface_cluster *cluster, const view *view);

#endif
