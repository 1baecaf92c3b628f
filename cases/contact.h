/* `shroudhb contact`: the contact law for a prescribed periodic motion, as YAML. */
#ifndef CASES_CONTACT_H
#define CASES_CONTACT_H

#include <stdio.h>

#include "mesh/status.h"

/* Read path (a contact: block and a motion:), print to out
 *   force: {n: [[amplitude, phase], ...], u: ..., w: ...}   harmonics 0..15, N and deg, x(t) = Re sum A_k exp(jkwt)
 *   transitions: [[phase in 0..1, stick | slip | open], ...]
 *   dissipation: J a cycle
 *   mean_friction: determined | undetermined
 * n is the normal load itself, preload included. Errors are printed by the reader. */
shb_status contact_command(const char *path, FILE *out);

#endif
