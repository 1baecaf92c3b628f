/* The files that a script of gmsh (.geo) reads. */
#ifndef MESH_GMSH_SCRIPT_FILES_H
#define MESH_GMSH_SCRIPT_FILES_H

#include <stddef.h>
#include <sys/types.h>

#include "mesh/base/status.h"

enum { MESH_MOST_FILES = 256 };

/* Files in the order in which they were found; the first one has the others. */
typedef struct {
  int   n;
  char *path[MESH_MOST_FILES];   /* malloc'ed */
  dev_t device[MESH_MOST_FILES]; /* these two tell files apart: ./a is a */
  ino_t inode[MESH_MOST_FILES];
} mesh_file_list;

/* Start a list with a file. */
void mesh_files_begin(const char *path, mesh_file_list *list);
void mesh_files_free(mesh_file_list *list);

/* Add the file `name` of n characters, in the folder of the file `from`, if it is a file and not
 * there yet. Errors: SHB_ERR_INPUT too many files.
 *   at  out  its place in the list; -1: it is no file */
shb_status mesh_files_add(mesh_file_list *list, const char *from, const char *name, size_t n,
                          int *at);

/* A list of a script and of all files that it reads, at any depth: those whose name stands in it in
 * quotes (Include, Merge, ShapeFromFile). Names are taken from the folder of the file that has
 * them. Errors: as mesh_files_add; free the list in any case. */
shb_status mesh_script_files(const char *path, mesh_file_list *list);

#endif
