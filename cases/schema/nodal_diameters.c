#include "cases/schema/nodal_diameters.h"

#include <string.h>

#include "modal/model/nodal_diameters.h"

/* Nodal diameters of harmonics 0 to most. */
static int of_harmonics(const case_file *file, int most, int list[CASE_MOST_DIAMETERS]) {
  const int N                           = file->blades;
  bool      wanted[CASE_MOST_DIAMETERS] = {true};
  int       n                           = 0;
  for (int k = 0; k <= most; k++)
    wanted[modal_nodal_diameter((long)k * file->engine_order, N)] = true;
  for (int d = 0; d <= N / 2; d++)
    if (wanted[d]) list[n++] = d;
  return n;
}

int case_nodal_diameters(const case_file *file, int list[CASE_MOST_DIAMETERS]) {
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
  /* The truncation estimate looks at four times as many harmonics, and at twelve. */
  const int looked_at = mhb->harmonics > 3 ? 4 * mhb->harmonics : 12;
  return of_harmonics(file, mhb->harmonics > 0 ? looked_at : file->blades, list);
}
