/* The value of modal.damping. */
#ifndef CASES_PARSE_DAMPING_H
#define CASES_PARSE_DAMPING_H

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"
#include "modal/model/damping.h"

/* Read a ratio, a list of ratios, {loss_factor: eta} or {rayleigh: [alpha, beta]} (1/s, s). Every
 * fault is recorded under path. */
bool case_damping_read(case_issues *issues, const char *path, const case_node *node,
                       modal_damping *damping);

/* Print the value in SI units without an end of line. */
void case_damping_print(FILE *out, const modal_damping *damping);

#endif
