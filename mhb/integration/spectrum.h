/* The lines of a motion that does not repeat itself. */
#ifndef MHB_INTEGRATION_SPECTRUM_H
#define MHB_INTEGRATION_SPECTRUM_H

#include "mhb/integration/integrator.h"

enum { MHB_SPECTRUM_LINES = 8 };

/* Go on for a number of periods of the fundamental and tell the largest lines of the contact motion that is largest, up to ten
 * times the excitation's frequency.
 *   frequency, amplitude  out  [MHB_SPECTRUM_LINES] Hz, m, largest first; 0: there are no more
 * Resolution: 2/(periods x period) (Hann's window). 0: the forces of a step were not found, or no memory. */
int mhb_spectrum(mhb_integrator *integrator, int periods, double *frequency, double *amplitude);

#endif
