/* A cantilever whose mitred end is pressed against a rigid wall on a strip of its face: stick, slip
 * and lift-off, spread over an area.
 *
 * Geometry, mesh and numbers are those of example 04 of NLstep. Its paper is Monjaraz-Tec, Gross,
 * Krack, Computers & Structures 260, 2022. The bar is 300 mm by 50 mm by 30 mm of steel; a tip of
 * 20 mm tapers to 15 mm. There are 16 by 11 by 12 hexahedra. Theirs have eight nodes, ours
 * twenty.
 */
#ifndef TESTS_HARD_OBLIQUE_CANTILEVER_H
#define TESTS_HARD_OBLIQUE_CANTILEVER_H

/* Friction coefficient; pressure of the strip at rest, Pa; amplitude of the force, N; damping ratio
 * of the second mode with the strip fixed. The damping is proportional to the mass. */
#define OBLIQUE_MU .36
#define OBLIQUE_PRESSURE .4e6
#define OBLIQUE_FORCE 25.
#define OBLIQUE_DAMPING .05

/* Write folder/oblique.inp, in m, with the node sets root and contact_right. Write
 * folder/oblique.yaml, a case with contact to ground at every node of the strip. Its probe is the
 * force's node. Fails the test if it cannot. */
void oblique_cantilever_write(const char *folder);

#endif
