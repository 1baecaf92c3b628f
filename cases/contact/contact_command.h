/* `shroudhb contact`: the contact law for a prescribed motion, as YAML and as a picture. */
#ifndef CASES_CONTACT_CONTACT_COMMAND_H
#define CASES_CONTACT_CONTACT_COMMAND_H

#include <stdio.h>

#include "cases/schema/overrides.h"
#include "mesh/base/status.h"

/* Read a motion file and print to out
 *   force: {n: [[amplitude, phase], ...], u: ..., w: ...}   harmonics 0..15, N and deg
 *   transitions: [[phase in 0..1, stick | slip | open], ...]
 *   dissipation: J per cycle
 *   mean_friction: determined | undetermined
 * A force is x(t) = Re sum A_k exp(jkwt); n is the normal load including the preload.
 *
 *   overrides  in  of keys of the file, or NULL
 *   svg        in  path of a picture (hysteresis_picture.h), or NULL
 *
 * Errors: as case_motion_read. SHB_ERR_INPUT also if svg is the file that is read.
 * SHB_NOT_CONVERGED if the slider did not become periodic; everything is printed and drawn. */
shb_status contact_run(const char *path, const case_overrides *overrides, const char *svg,
                       FILE *out);

#endif
