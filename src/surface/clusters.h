/* surface/clusters.h - clusters of a mesh. A cluster is up to 64 triangles, or up to 64 spheres, that lie
 * close together. It has a box around its primitives, and a cone that holds their normals.
 *
 * A cluster that a view does not see at all is left out after a single test. A cluster of triangles has its
 * own copy of the triangles' vertices, so that these vertices lie side by side in memory. */
#ifndef HL_SURFACE_CLUSTERS_H
#define HL_SURFACE_CLUSTERS_H

#include "core/memory.h"
#include "surface/small_triangles.h"
#include "surface/surfaces.h"
#include "view/view.h"

enum { CLUSTER_SIZE = CLUSTER_TRIANGLES };

struct surface_cluster {
  float low[3], high[3]; /* the corners of the box around the cluster's primitives; frame space */
  float axis[3];         /* the axis of the cone that holds the normals; unit vector */
  float cosine;          /* the cosine of the greatest angle between the axis and a normal; a number below 0
                          * if the normals may have any direction */
  uint32_t first; /* the index, in all->order, of the cluster's first primitive. All primitives of a cluster
                   * are of the same kind, because the order keeps primitives of one kind together */
  uint16_t count, mesh;
  /* the number of the vertices in the cluster's own copy, for clusters of triangles; a multiple of 16, which
   * cluster_shape requires */
  uint16_t vertices;
  size_t first_vertex; /* the index, in all->cluster_positions, of the cluster's first vertex */
};

/* Counts the greatest amount of memory that hl_clusters_create() can take. It takes this amount if the
 * triangles share hardly any vertices. */
void hl_clusters_count(const hl_scene_description *scene, hl_layout *layout);

/* Makes the clusters of all meshes, in the order of the meshes. Clusters of triangles come before clusters
 * of spheres. */
hl_status hl_clusters_create(hl_context *context, hl_pool *pool, surfaces *all, hl_error *error);
void hl_clusters_release(hl_context *context, surfaces *all);

/* Describes a cluster of triangles for the functions of small triangles (small_triangles.h). The arrays are
 * borrowed. */
static inline cluster_shape hl_cluster_shape(const surfaces *all, const surface_cluster *cluster) {
  size_t number = (size_t)(cluster - all->clusters);
  return (cluster_shape){all->cluster_positions + 3 * cluster->first_vertex, cluster->vertices,
                         all->cluster_corners[number], all->cluster_normals[number]};
}

/* The least height of a cluster's box above the first sheet of a view. */
double hl_lowest_height(const sheet_stack *sheets, const surface_cluster *cluster);

/* Returns whether every triangle of a cluster surely turns its back to the view, by more than a small
 * angle. */
bool hl_cluster_faces_away(const surface_cluster *cluster, const view *view);

#endif
