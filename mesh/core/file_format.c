#include "mesh/core/file_format.h"

#include <string.h>
#include <strings.h>

mesh_format mesh_format_of(const char *path) {
  static const struct {
    const char *ending;
    mesh_format format;
  } known[] = {{".msh", MESH_FORMAT_MSH},  {".inp", MESH_FORMAT_INP},   {".step", MESH_FORMAT_STEP},
               {".stp", MESH_FORMAT_STEP}, {".brep", MESH_FORMAT_BREP}, {".geo", MESH_FORMAT_GEO}};
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot && dot != path && i < sizeof known / sizeof *known; i++)
    if (strcasecmp(dot, known[i].ending) == 0) return known[i].format;
  return MESH_FORMAT_UNKNOWN;
}
