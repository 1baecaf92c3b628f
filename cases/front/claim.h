/* One `shroudhb run` at a time works on a name in a folder, so that stages of two do not mix. */
#ifndef CASES_FRONT_CLAIM_H
#define CASES_FRONT_CLAIM_H

#include "cases/parse/case_file.h"

/* Claim the results of a case. The claim is the address of a socket: it ends with the process,
 * however that ends, and leaves no file. It is known on this machine alone.
 *   *claim  out  descriptor that holds it; negative where the system has no such sockets
 * Errors: SHB_ERR_IO another run holds it. */
shb_status claim_results(const case_file *file, int *claim);

#endif
