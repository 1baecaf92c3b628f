/* Nodal diameters of a sector with a disc that a case needs. */
#ifndef CASES_SCHEMA_NODAL_DIAMETERS_H
#define CASES_SCHEMA_NODAL_DIAMETERS_H

#include "cases/parse/case_file.h"

/* List them in ascending order, 0 among them.
 *
 * auto: harmonic k of the balance meets the disc at nodal diameter k E mod N, or N minus that. With
 * mhb.harmonics: auto k runs through all harmonics. Without an engine order, and with subharmonics
 * or a search, all of 0 to N/2.
 *   list  out  [n] from 0
 * Returns n, or -1 for all of 0 to N/2. */
int case_nodal_diameters(const case_file *file, int list[CASE_MOST_DIAMETERS]);

#endif
