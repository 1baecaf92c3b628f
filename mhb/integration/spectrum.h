/* Largest lines of a motion that does not repeat itself. */
#ifndef MHB_INTEGRATION_SPECTRUM_H
#define MHB_INTEGRATION_SPECTRUM_H

#include "mhb/integration/integrator.h"

enum { MHB_SPECTRUM_LINES = 8 };

/* Largest lines of a signal, by a Fourier transform with Hann's window.
 *   x                     inout  [n] samples; left without mean, windowed
 *   duration              in     s, of all n samples
 *   top                   in     highest bin, at most n/2 - 1; a bin is 1/duration wide
 *   frequency, amplitude  out    [MHB_SPECTRUM_LINES] Hz, unit of x; largest first, then zeros
 * Frequencies are interpolated between the bins; lines less than 2/duration apart are not resolved.
 */
void mhb_spectrum_lines(int n, double *x, double duration, int top, double *frequency,
                        double *amplitude);

/* Integrate over a number of periods of the fundamental. The lines are those of the axis of contact
 * 0 that moves most, up to ten times the excitation's frequency.
 *   frequency, amplitude  out  [MHB_SPECTRUM_LINES] Hz, m, as above
 * Without the forces of a step there are no lines. */
void mhb_spectrum(mhb_integrator *integrator, int periods, double *frequency, double *amplitude);

#endif
