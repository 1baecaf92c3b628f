/* What readers get of NAME.study.h5: NAME.study.html, NAME.study.csv and NAME.study.svg. */
#ifndef POSTPROC_STUDY_STUDY_PUBLISH_H
#define POSTPROC_STUDY_STUDY_PUBLISH_H

#include "postproc/study/design_study.h"

/* Is this the name of a study file: "….study.h5"? */
bool study_publish_takes(const char *path);

/* Publish page, table and picture of a study beside its file. A study without a result has no
 * picture.
 *
 *   path  of the study file, "DIR/NAME.study.h5": where the others go
 *
 * Errors: SHB_ERR_IO; SHB_ERR_INPUT the path does not end in .study.h5. */
shb_status study_publish(const design_study *study, const char *path);

/* Read a study file and publish it.
 *
 *   summary  out  "NAME.study.html: one line"; malloc'ed, or NULL
 *
 * Errors: as study_file_read and study_publish. */
shb_status study_publish_file(const char *path, char **summary);

#endif
