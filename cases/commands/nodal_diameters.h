/* Nodal diameters of a sector with a disc that a case needs. */
#ifndef CASES_COMMANDS_NODAL_DIAMETERS_H
#define CASES_COMMANDS_NODAL_DIAMETERS_H

#include "cases/parse/case_file.h"

/* List them in ascending order, 0 among them.
 *
 * auto: harmonic k of the balance meets the disc at nodal diameter k E mod N, or N minus that. With
 * mhb.harmonics: auto k runs through all harmonics. Without an engine order, and with subharmonics
 * or a search, all of 0 to N/2.
 *   list  out  [n] from 0
 * Returns n, or -1 for all of 0 to N/2. */
int nodal_diameters(const case_file *file, int list[CASE_MOST_DIAMETERS]);

/* Does the modal file at path hold all of them? true also if it is no file of nodal diameters. */
bool nodal_diameters_held(const case_file *file, const char *path);

#endif
