/* tests/oracle/dump_mesh.c - prints a mesh as Halflight reads it, for comparison with other readers.
 *
 *   dump_mesh FILE
 *
 * A line is "v" and a position, normal and colour, "t" and three vertices and a colour, or "s" and a sphere
 * and a colour; what a mesh does not have is left out: "-". */
#include <stdio.h>

#include <halflight/halflight.h>

static void print(const float *numbers, int count) {
  if (numbers == NULL) printf(" -");
  for (int n = 0; numbers != NULL && n < count; n++) printf(" %.9g", (double)numbers[n]);
}

static const float *row(const float (*rows)[4], size_t n) { return rows != NULL ? rows[n] : NULL; }

static void dump(const hl_mesh_description *d) {
  for (size_t v = 0; v < d->vertex_count; v++) {
    printf("v");
    print(d->positions[v], 3);
    print(d->normals != NULL ? d->normals[v] : NULL, 3);
    print(row(d->colors, v), 4);
    printf("\n");
  }
  for (size_t t = 0; t < d->triangle_count; t++) {
    printf("t %u %u %u", d->triangles[t][0], d->triangles[t][1], d->triangles[t][2]);
    print(row(d->face_colors, t), 4);
    printf("\n");
  }
  for (size_t s = 0; s < d->sphere_count; s++) {
    printf("s");
    print(d->spheres[s], 4);
    print(row(d->sphere_colors, s), 4);
    printf("\n");
  }
}

int main(int argc, char **argv) {
  hl_context *context = NULL;
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  if (argc != 2 || hl_context_create(NULL, &context, &error) != HL_OK) return 2;
  hl_status status = hl_mesh_load(context, argv[1], &mesh, &error);
  if (status == HL_OK) dump(hl_mesh_describe(mesh));
  else fprintf(stderr, "%s\n", error.message);
  hl_mesh_release(mesh);
  hl_context_destroy(context);
  return status == HL_OK ? 0 : 1;
}
