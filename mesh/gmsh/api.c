#include "mesh/gmsh/api.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <string.h>

/* MESH_GMSH_SONAME, MESH_GMSH_PATH: of the library that CMake found. */

typedef void any_function(void);

/* POSIX: what dlsym returns may be a function. */
static any_function *find(void *library, const char *name, bool *all) {
  any_function *found  = NULL;
  void         *symbol = dlsym(library, name);
  *all                 = *all && symbol;
  memcpy(&found, &symbol, sizeof found);
  return found;
}

/* A global, as gmsh itself has one state a process. Only the first thread calls gmsh. */
static mesh_gmsh_functions functions;
static bool                loaded;

shb_status mesh_gmsh_load(void) {
  bool all = true;
  if (loaded) return SHB_OK;
  void *library = dlopen(MESH_GMSH_SONAME, RTLD_LAZY);
  if (!library) library = dlopen(MESH_GMSH_PATH, RTLD_LAZY);
  SHB_CHECK(library, SHB_ERR_IO, "gmsh's library cannot be loaded: %s", dlerror());
#define MESH_GMSH_FIND(name) \
  functions.name = (__typeof__(functions.name))find(library, "gmsh" #name, &all);
  MESH_GMSH_FUNCTIONS(MESH_GMSH_FIND)
#undef MESH_GMSH_FIND
  SHB_CHECK(all, SHB_ERR_IO, "%s lacks functions of gmsh 4.8", MESH_GMSH_SONAME);
  loaded = true;
  return SHB_OK;
}

const mesh_gmsh_functions *mesh_gmsh(void) {
  (void)mesh_gmsh_load();
  return &functions;
}
