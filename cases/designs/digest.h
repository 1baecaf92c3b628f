/* Digests: two inputs with equal digests give equal results, so they are computed once. */
#ifndef CASES_DESIGNS_DIGEST_H
#define CASES_DESIGNS_DIGEST_H

#include "cases/designs/output_names.h"
#include "cases/parse/case_file.h"
#include "mesh/base/status.h"

enum { DIGEST_TEXT = 17 };

/* Fingerprints of the files that a case reads (mesh, modes, load fields, deviations), as text;
 * malloc'ed. A design cannot change them. Errors: SHB_ERR_IO. */
shb_status digest_inputs(const case_file *file, char **inputs);

/* Digest of mesh and modes of a case. */
void digest_modes(const case_file *file, const char *inputs, char out[DIGEST_TEXT]);

/* Digest of everything that the outputs depend on. */
void digest_design(const case_file *file, const char *inputs, int n_outputs,
                   const study_output *output, char out[DIGEST_TEXT]);

#endif
