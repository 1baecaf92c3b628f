/* What tracked peaks are held against: frequency sweeps at single values of the parameter. */
#ifndef TESTS_SUPPORT_PEAK_SCAN_H
#define TESTS_SUPPORT_PEAK_SCAN_H

#include <stdbool.h>

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* A tracked run: its sweeps have the same model, frequencies, output and number of harmonics. */
typedef struct {
  const modal_model  *model;
  const mhb_settings *settings;
} peak_scan;

/* The tracked run itself. Fails the test if it has no result. */
mhb_response *peak_scan_follow(const peak_scan *scan);

/* The main curve at a value of the parameter. Fails the test if it cannot be traced. */
mhb_response *peak_scan_sweep(const peak_scan *scan, double value);

/* The highest amplitude of that curve. */
double peak_scan_highest(const peak_scan *scan, double value);

/* The least of these over the parameter's range, and where it is. First comes the lowest of n + 1
 * values, then the root of the difference between two sweeps beside it, at a relative distance.
 * 1e-3 leaves an error of some 1e-6 where the peak is smooth. At a kink the error is of the order
 * of the distance. Fails the test where the lowest of the n + 1 values is an end of the range. */
double peak_scan_lowest(const peak_scan *scan, int n, double distance);

/* Check that the optimum of a tracked response is verified. Its place must be that of a scan with
 * nine values to 1e-5, its amplitude that of the sweep there to 1e-7. */
void peak_scan_check_optimum(const peak_scan *scan, const mhb_response *tracked);

/* Amplitude of the output at a maximum of a sweep, a point no lower than those beside it. Of
 * several, the nearest to a frequency. The sweep is of its neighbourhood; where that begins on
 * another motion, sweeps of narrower and wider ones follow. NAN: there is none.
 *   frequency  inout  Hz
 *   first      out    whether the first harmonic has one there too */
double peak_scan_near(const peak_scan *scan, double value, double *frequency, bool *first);

/* How far the tracked peaks of a response are from those of sweeps, without the ends of branches.
 *
 * Where a maximum and a minimum meet, a sweep steps over both. It locates a corner to 2e-6 of the
 * frequency only, where the amplitude is steep. Such peaks count in n_on_curve and not in the
 * differences. The sweep's curve must have their amplitude to 1e-6 at their frequency. It must be
 * level there, nowhere higher within 2e-5, or have its corner within 2e-6. */
typedef struct {
  int    n, n_first, n_on_curve; /* peaks; those that are peaks of the first harmonic too */
  double amplitude, frequency;   /* largest relative difference of the others */
} peak_agreement;

peak_agreement peak_scan_compare(const peak_scan *scan, const mhb_response *tracked);

#endif
