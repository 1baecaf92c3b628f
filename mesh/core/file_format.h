/* Kind of a mesh file by the ending of its name; capitals do not matter. */
#ifndef MESH_CORE_FILE_FORMAT_H
#define MESH_CORE_FILE_FORMAT_H

typedef enum {
  MESH_FORMAT_UNKNOWN,
  MESH_FORMAT_MSH,  /* .msh: a mesh of gmsh */
  MESH_FORMAT_INP,  /* .inp: a mesh of Abaqus or CalculiX */
  MESH_FORMAT_STEP, /* .step, .stp: a solid with its own unit of length */
  MESH_FORMAT_BREP, /* .brep: a solid of OpenCASCADE */
  MESH_FORMAT_GEO,  /* .geo: a script of gmsh */
} mesh_format;

mesh_format mesh_format_of(const char *path);

/* Is it a solid, to be meshed here? */
#define MESH_FORMAT_IS_SOLID(format) ((format) >= MESH_FORMAT_STEP)

#endif
