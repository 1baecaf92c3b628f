/* `shroudhb contact`: the contact law for a prescribed periodic motion, as YAML and as a picture. */
#ifndef CASES_COMMANDS_CONTACT_COMMAND_H
#define CASES_COMMANDS_CONTACT_COMMAND_H

#include <stdio.h>

#include "mesh/base/status.h"

/* Read path (a contact: block and a motion:), print to out
 *   force: {n: [[amplitude, phase], ...], u: ..., w: ...}   harmonics 0..15, N and deg, x(t) = Re sum A_k exp(jkwt)
 *   transitions: [[phase in 0..1, stick | slip | open], ...]
 *   dissipation: J a cycle
 *   mean_friction: determined | undetermined
 * n is the normal load itself, preload included. svg: draw it there too (hysteresis_picture.h), whole or not at all; NULL: no picture.
 * Errors are printed by the reader. SHB_ERR_INPUT also where svg is the file that is read; SHB_NOT_CONVERGED where the
 * periodic slider was not reached (all is printed and drawn). */
shb_status contact_command(const char *path, const char *svg, FILE *out);

#endif
