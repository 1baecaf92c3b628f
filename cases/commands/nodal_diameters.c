#include "cases/commands/nodal_diameters.h"

#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5.h"

/* Nodal diameters of harmonics 0 to most. */
static int of_harmonics(const case_file *file, int most, int list[CASE_MOST_DIAMETERS]) {
  const int N                           = file->blades;
  bool      wanted[CASE_MOST_DIAMETERS] = {true};
  int       n                           = 0;
  for (int k = 0; k <= most; k++) {
    const int wave                          = (int)((long)k * file->engine_order % N);
    wanted[wave <= N / 2 ? wave : N - wave] = true;
  }
  for (int d = 0; d <= N / 2; d++)
    if (wanted[d]) list[n++] = d;
  return n;
}

int nodal_diameters(const case_file *file, int list[CASE_MOST_DIAMETERS]) {
  const case_diameters *given = &file->diameters;
  const mhb_settings   *mhb   = &file->mhb;
  if (given->what == CASE_DIAMETERS_ALL || file->blades < 2) return -1;
  if (given->what == CASE_DIAMETERS_LISTED) {
    memcpy(list, given->list, (size_t)given->n * sizeof *list);
    return given->n;
  }
  if (!file->has_contact || file->engine_order == 0 || mhb->subharmonics > 1 ||
      mhb->search.starts > 0)
    return -1;
  return of_harmonics(file, mhb->harmonics > 0 ? mhb->harmonics : file->blades, list);
}

static bool holds(int n, const int *held, int diameter) {
  for (int i = 0; i < n; i++)
    if (held[i] == diameter) return true;
  return false;
}

bool nodal_diameters_held(const case_file *file, const char *path) {
  int   n = 0, *held = NULL, list[CASE_MOST_DIAMETERS];
  bool  all = true;
  hid_t at;
  if (h5_open(path, &at) != SHB_OK) return true;
  if (h5_exists(at, "/nodal_diameter_0") &&
      h5_read_attribute_ints(at, "/", "nodal_diameters", &n, &held) == SHB_OK && n > 0) {
    const int wanted = nodal_diameters(file, list);
    for (int i = 0; i < wanted; i++) all = all && holds(n, held, list[i]);
    for (int d = 0; wanted < 0 && d <= file->blades / 2; d++) all = all && holds(n, held, d);
  }
  free(held);
  h5_close(at);
  return all;
}
