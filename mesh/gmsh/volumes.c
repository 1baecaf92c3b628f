#include "mesh/gmsh/volumes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/regions.h"
#include "mesh/core/triangle.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

/* gmsh's volume (entity) of each element. */
typedef struct {
  const char *path;
  mesh_fe    *mesh;
  long (*by_tag)[2]; /* [n_elements] tag, index; ascending */
  int *entity;       /* [n_elements] */
} model;

static int by_first(const void *a, const void *b) {
  long p = *(const long *)a, q = *(const long *)b;
  return (p > q) - (p < q);
}

static void mark(model *m, const size_t *tags, size_t n, int entity) {
  for (size_t i = 0; i < n; i++) {
    long        tag = (long)tags[i];
    const long *found =
        bsearch(&tag, m->by_tag, (size_t)m->mesh->n_elements, sizeof *m->by_tag, by_first);
    if (found) m->entity[found[1]] = entity;
  }
}

static shb_status find_entities(model *m) {
  int   *entities = NULL, type = mesh_topology_of(m->mesh->kind)->gmsh;
  size_t n = 0;
  GMSH_TRY(m->path, gmshModelGetEntities(&entities, &n, 3, &ierr));
  int ierr = 0;
  for (size_t i = 0; i + 1 < n && ierr == 0; i += 2) {
    size_t *tags = NULL, *nodes = NULL, n_tags = 0, n_nodes = 0;
    gmshModelMeshGetElementsByType(type, &tags, &n_tags, &nodes, &n_nodes, entities[i + 1], 0, 1,
                                   &ierr);
    if (ierr == 0) mark(m, tags, n_tags, entities[i + 1]);
    gmshFree(tags);
    gmshFree(nodes);
  }
  gmshFree(entities);
  return ierr ? mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, m->path) : SHB_OK;
}

static shb_status fill(model *m) {
  const size_t n = (size_t)m->mesh->n_elements;
  m->by_tag      = shb_alloc(n, sizeof *m->by_tag);
  m->entity      = shb_alloc_zeroed(n + 1, sizeof *m->entity);
  for (size_t e = 0; e < n; e++) {
    m->by_tag[e][0] = m->mesh->element_tag[e];
    m->by_tag[e][1] = (long)e;
  }
  qsort(m->by_tag, n, sizeof *m->by_tag, by_first);
  return find_entities(m);
}

static void put_entity(const model *m, mesh_regions *regions, int entity, int volume) {
  for (int e = 0; e < m->mesh->n_elements; e++)
    if (m->entity[e] == entity) mesh_regions_assign(regions, e, volume);
}

/* Largest signed distance of a point from the planes of an element's faces, m; negative inside. */
static double outside(const mesh_fe *mesh, int element, const double at[3]) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int           *nodes    = mesh->connectivity + topology->nodes * (size_t)element;
  double               worst    = -INFINITY;
  for (int f = 0; f < topology->faces; f++) {
    mesh_triangle part[MESH_TRIANGLES];
    int           face[MESH_FACE_NODES];
    for (int i = 0; i < topology->face_nodes; i++) face[i] = nodes[topology->face[f][i]];
    for (int i = mesh_triangles(mesh, face, part) - 1; i >= 0; i--) {
      double area[3], from[3];
      mesh_triangle_area(&part[i], area);
      vec3_minus(at, part[i].x[0], from);
      const double size = vec3_norm(area);
      if (size > 0) worst = fmax(worst, vec3_dot(area, from) / size);
    }
  }
  return worst;
}

static int element_at(const mesh_fe *mesh, const double at[3]) {
  int    nearest = 0;
  double least   = INFINITY;
  for (int e = 0; e < mesh->n_elements && least > 0; e++) {
    double distance = outside(mesh, e, at);
    if (distance < least) nearest = e;
    least = fmin(least, distance);
  }
  return nearest;
}

/* Fail with the list of the physical volumes in the file. */
static shb_status refuse_absent(const model *m, const char *name) {
  int   *groups = NULL;
  size_t n = 0, used = 0;
  char   known[512] = "none";
  GMSH_TRY(m->path, gmshModelGetPhysicalGroups(&groups, &n, 3, &ierr));
  for (size_t i = 0; i + 1 < n; i += 2) {
    char *label = NULL;
    int   ierr  = 0;
    gmshModelGetPhysicalName(3, groups[i + 1], &label, &ierr);
    if (ierr == 0 && label && label[0] && used + strlen(label) + 3 < sizeof known)
      used += (size_t)sprintf(known + used, "%s%s", used ? ", " : "", label);
    gmshFree(label);
  }
  gmshFree(groups);
  SHB_FAIL(SHB_ERR_INPUT,
           "%s: no physical volume '%s' (there: %s); name it in the file, or say which it is by a "
           "rule in mesh.groups",
           m->path, name, known);
}

static shb_status put_named(const model *m, mesh_regions *regions, int volume) {
  const char *name   = regions->names->volume[volume].name;
  int        *groups = NULL, *entities = NULL, tag = -1;
  size_t      n = 0, n_entities = 0;
  GMSH_TRY(m->path, gmshModelGetPhysicalGroups(&groups, &n, 3, &ierr));
  for (size_t i = 0; i + 1 < n && tag < 0; i += 2) {
    char *label = NULL;
    int   ierr  = 0;
    gmshModelGetPhysicalName(3, groups[i + 1], &label, &ierr);
    if (ierr == 0 && label && strcmp(label, name) == 0) tag = groups[i + 1];
    gmshFree(label);
  }
  gmshFree(groups);
  if (tag < 0) return refuse_absent(m, name);
  GMSH_TRY(m->path, gmshModelGetEntitiesForPhysicalGroup(3, tag, &entities, &n_entities, &ierr));
  for (size_t i = 0; i < n_entities; i++) put_entity(m, regions, entities[i], volume);
  gmshFree(entities);
  return SHB_OK;
}

static shb_status take_all(model *m, const mesh_names *names) {
  mesh_regions regions;
  SHB_TRY(fill(m));
  mesh_regions_begin(m->path, names, m->mesh, &regions);
  for (int i = 0; i < names->n_volumes; i++) {
    if (names->volume[i].near) {
      put_entity(m, &regions, m->entity[element_at(m->mesh, names->volume[i].at)], i);
    } else {
      SHB_TRY(put_named(m, &regions, i));
    }
  }
  return mesh_regions_end(&regions);
}

shb_status mesh_volumes_assign(const char *path, const mesh_names *names, mesh_fe *mesh) {
  model      m      = {.path = path, .mesh = mesh};
  shb_status status = take_all(&m, names);
  free(m.by_tag);
  free(m.entity);
  return status;
}
