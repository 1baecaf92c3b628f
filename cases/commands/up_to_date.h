/* Is the file of a stage up to date? A stage runs again only if its settings have changed. */
#ifndef CASES_COMMANDS_UP_TO_DATE_H
#define CASES_COMMANDS_UP_TO_DATE_H

#include <stdbool.h>

#include "cases/parse/case_file.h"

/* Everything that the output of a stage depends on, as text: its keys, and the contents of its
 * input file. *text is malloc'ed. Errors: SHB_ERR_IO. */
shb_status up_to_date_settings(const case_file *file, case_stage stage, const char *input,
                               char **text);

/* The same of NAME.msh, which is made: its keys, and the pitch at which its sides must match. Of
 * mesh.file the contents count, with all that it includes. */
shb_status up_to_date_mesh_settings(const case_file *file, char **text);

/* Was the mesh at path made from these settings? */
bool up_to_date_mesh(const char *path, const char *settings);

/* Are the mesh that the case makes and its modal file what `shroudhb run` would leave? Where there
 * is no mesh any more, the keys of the modal file count. */
bool up_to_date_modes(const case_file *file);

/* Does the modal file at path hold the nodal diameters of the case? true also if it is no file of
 * nodal diameters. */
bool up_to_date_diameters(const case_file *file, const char *path);

/* The fingerprint of the modal file from which a response or integration file was computed. False:
 * it is not known, as of versions before 0.2. */
bool up_to_date_modal_of(const char *path, char fingerprint[17]);

/* Was the response file computed from this modal file? Errors: SHB_ERR_INPUT it was not, with what
 * to do; SHB_ERR_IO. */
shb_status up_to_date_check_modal(const char *response, const char *modal);

/* The settings that the HDF5 file at path was made from; malloc'ed, NULL if unknown. */
char *up_to_date_written(const char *path);

/* Was the HDF5 file at path made from these settings? */
bool up_to_date_with(const char *path, const char *settings);

/* Was the HDF5 file at path made from the present keys of stage? */
bool up_to_date_keys(const case_file *file, case_stage stage, const char *path);

/* Print a warning line on stderr if the response file was made from other keys. A file that cannot
 * be read is no reason to warn. */
void up_to_date_warn(const case_file *file, const char *response);

#endif
