/* A mesh from any source that must be refused. */
#ifndef TESTS_SUPPORT_READ_SOURCE_H
#define TESTS_SUPPORT_READ_SOURCE_H

#include "mesh/io/source.h"
#include "tests/support/check.h"

/* Fails unless reading the source is refused in one line with these words, and leaves no mesh. */
static inline void assert_source_refused(const mesh_source *source, const char *words) {
  mesh_fe mesh;
  assert_refused(mesh_source_read(source, NULL, &mesh), SHB_ERR_INPUT, words);
  assert_null(mesh.coordinates);
  assert_null(mesh.region);
}

#endif
