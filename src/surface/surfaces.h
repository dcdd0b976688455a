/* surface/surfaces.h - describes the triangles and spheres of all meshes of a scene, in frame space.
 *
 * In: the scene's meshes. Out: the surfaces that fragments.c rasterises and the sweep shades. Surfaces are
 * kept between frames as long as the same meshes stand in the same places. */
#ifndef HL_SURFACE_SURFACES_H
#define HL_SURFACE_SURFACES_H

#include <halflight/scene.h>

#include "core/error.h"
#include "core/key.h"
#include "core/pool.h"
#include "core/vector.h"
#include "scene/geometry/cut.h"
#include "surface/primitive_kinds.h"

/* The look of a mesh, and the fraction of light that the mesh absorbs. */
typedef struct surface_look {
  double color[3];             /* linear RGB; the colour of the mesh's material */
  double opacity;              /* a factor on the opacities of the mesh's vertices */
  double attenuation_color[3]; /* factors on `opacity` for red, green and blue: the products are the fractions
                                * of light of these colours that the mesh absorbs */
  hl_material material;
  bool smooth;    /* whether normals are interpolated between vertices */
  bool two_sided; /* whether the side that faces away from the eye is lit like the front */
  bool visible, casts_shadow, receives_shadow;
} surface_look;

surface_look hl_surface_look(const hl_scene_mesh *mesh);

typedef struct surface_mesh {
  surface_look look;               /* the look of the mesh in the current frame */
  hl_mesh *mesh;                   /* retained, because its arrays are borrowed */
  affine3 placement;               /* maps the mesh to frame space */
  double scale;                    /* the length, in frame units, of the mesh's own unit of length */
  const float (*colors)[4];        /* borrowed; [vertices of the mesh]; null if the vertices have no colours
                                    * of their own */
  const float (*face_colors)[4];   /* borrowed; [triangles of the mesh]; null if the triangles have no colours
                                    * of their own */
  const float (*sphere_colors)[4]; /* borrowed; [spheres of the mesh]; null if the spheres have no colours of
                                    * their own */
  const uint32_t (*edges)[3];      /* borrowed; [triangles of the mesh]; the indices of the normals at
                                    * sharp edges, as in hl_mesh */
  size_t first_vertex;             /* the number of the mesh's first vertex in positions and normals */
  size_t first_edge_normal;
  primitive_range primitives[PRIMITIVE_KINDS];
  bool is_cut; /* whether the cuts may remove a part of the mesh */
} surface_mesh;

typedef struct surface_cluster surface_cluster; /* see clusters.h */
typedef struct surface_seam surface_seam;       /* see late/surface_seams.h */

/* The surfaces of a scene. Each primitive has a number. The numbers of the primitives of one kind follow the
 * numbers of the kind before. */
typedef struct surfaces {
  /* owned, in one block with the next five arrays; [mesh_count]. Among the primitives of one kind, the
   * primitives of a mesh follow the primitives of the mesh before */
  surface_mesh *meshes;
  float (*positions)[3];     /* [vertex_count]; positions of the vertices; frame space */
  float (*normals)[3];       /* [vertex_count]; unit normals, or 0 where a vertex has none; frame space */
  float (*edge_normals)[3];  /* [edge_normal_count]; unit normals at sharp edges; frame space */
  uint32_t (*triangles)[3];  /* [triangles]; each triangle's corners, as indices in `positions` */
  float (*spheres)[4];       /* [spheres]; each sphere's centre and radius; frame space */
  surface_cluster *clusters; /* owned, in one block with the next three arrays; [cluster_count]; the
                              * clusters of all meshes */
  uint32_t *order;           /* [primitives]; numbers of the primitives, in the order of clusters */
  uint8_t (*cluster_corners)[3][64]; /* [clusters of triangles]; the corners of each triangle, as numbers of
                                      * the cluster's vertices */
  float (*cluster_normals)[3][64];   /* [clusters of triangles]; the cross product of each triangle's
                                      * sides, from hl_corner_product(), axis by axis; frame space */
  float *cluster_positions;          /* owned; for each cluster of triangles, the positions of its vertices:
                                      * [3][vertices]; frame space */
  surface_seam *seams;               /* owned; [seam_count]; the corners at which large triangles meet; null
                                      * if there are none */
  cut_shape *cuts;                   /* owned; [cut_count]; the scene's cuts, in frame space */
  size_t cut_count, cluster_count, seam_count;
  size_t mesh_count, vertex_count, edge_normal_count;
  uint32_t first[PRIMITIVE_KINDS + 1]; /* first: the number of the first primitive of each kind; the last
                                        * element is the number of all primitives */
} surfaces;

/* Adds to a key everything that decides how much light surfaces absorb. If all is null, there are no
 * surfaces. */
void hl_surfaces_key_add(hl_key *key, const surfaces *all);

/* The number of primitives. */
static inline uint32_t hl_surfaces_count(const surfaces *all) { return all->first[PRIMITIVE_KINDS]; }

/* Returns whether the scene's cuts leave a mesh at a point of frame space. */
static inline bool hl_surface_left(const surfaces *all, const surface_mesh *mesh, vec3 point) {
  return !mesh->is_cut || hl_cuts_leave(all->cuts, all->cut_count, point);
}

/* Finds the corners of a box around a mesh; frame space. The box of a flat mesh gets the thickness
 * `least`. */
void hl_surface_corners(const surface_mesh *mesh, double least, vec3 corners[8]);

/* Returns whether a mesh is closed, has the opacity 1 (colours of its vertices and triangles are ignored),
 * and no cut can remove a part of it. */
bool hl_surface_is_closed(const surface_mesh *mesh);

/* Returns whether a mesh lets no light pass, except where cuts have removed it. */
bool hl_surface_takes_all(const surface_mesh *mesh);

/* Returns whether a mesh lets no light pass, and no cut removes a part of it. */
bool hl_surface_is_opaque(const surface_mesh *mesh);

/* Returns whether a ball lies outside of a mesh's box, at a distance of at least a hundredth of the box's
 * edges; frame space. */
bool hl_surface_is_outside(const surface_mesh *mesh, vec3 centre, double radius);

/* Reads a position from surfaces->positions, or a normal from surfaces->normals. */
static inline vec3 hl_surface_vector(const float v[3]) { return (vec3){v[0], v[1], v[2]}; }

/* Finds a triangle's unit normal. It is 0 for a triangle without an area. */
static inline vec3 hl_surface_normal(const surfaces *all, uint32_t triangle) {
  vec3 at[3];
  for (int i = 0; i < 3; i++) at[i] = hl_surface_vector(all->positions[all->triangles[triangle][i]]);
  return vec3_normalise(vec3_cross(vec3_subtract(at[1], at[0]), vec3_subtract(at[2], at[0])));
}

#endif
