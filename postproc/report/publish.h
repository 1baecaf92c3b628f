/* The stage: from NAME.response.h5 to NAME.html, NAME.csv and NAME.svg; with modes at several
 * speeds also NAME.campbell.svg. */
#ifndef POSTPROC_REPORT_PUBLISH_H
#define POSTPROC_REPORT_PUBLISH_H

#include "mesh/base/axes.h"
#include "mesh/base/progress.h"
#include "mesh/base/status.h"
#include "mhb/problem/settings.h"

typedef struct {
  const char         *case_name;        /* title of the page */
  const char         *response;         /* file to read */
  const char         *html, *csv, *svg; /* files to write, each whole; html NULL: the table only */
  const char         *convergence;      /* NAME.converge.h5 for the page, or NULL */
  const char         *integration;      /* file of points by time integration, or NULL */
  const char         *modal;            /* modal file, for blade and modes over speed, or NULL */
  const char         *campbell;         /* picture of these modes to write, or NULL */
  const mhb_settings *settings;         /* of the response; NULL: not known, no loops are drawn */
  const char         *stress;           /* section of the page on stress, HTML, or NULL */
  mesh_axis           axis;             /* of the engine */
  double              speed;            /* of the rotor, rad/s; 0: none, or a range */
} post_job;

/* Nothing is written unless everything could be composed. summary: malloc'ed line for the terminal,
 * or NULL. Errors: as mhb_response_read and post_convergence_read; SHB_ERR_INPUT no point;
 * SHB_ERR_IO. */
shb_status post_publish(const post_job *job, shb_progress *progress, char **summary);

#endif
