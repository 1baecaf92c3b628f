/* Modal model of one blade and its file: the structural data of the harmonic balance. Free of
 * PETSc. The arrays and their datasets are in modal/model/model_table.h. */
#ifndef MODAL_MODEL_MODEL_H
#define MODAL_MODEL_MODEL_H

#include "modal/model/model_table.h"

/* Version of the file format with nodal diameters (nodal_diameters.h), and the newest that is
 * read. */
enum { MODAL_DIAMETERS_VERSION = 3, MODAL_NEWEST = MODAL_DIAMETERS_VERSION };

/* Whether harmonic k of the load moves a mode. */
bool modal_model_is_driven(const modal_model *model, int k);

/* Write the datasets of docs/user/files.md into an open file, with the attributes format and
 * provenance. */
shb_status modal_model_write(hid_t file, const modal_model *model,
                             const shb_provenance *provenance);

/* The same datasets in a group of an open file, without attributes. */
shb_status modal_model_write_at(hid_t at, const modal_model *model);

/* Read the datasets from a group; path names it in messages. model is zeroed before the call and
 * freed by the caller in any case. */
shb_status modal_model_read_at(hid_t at, const char *path, modal_model *model);

/* Both for a travelling wave, whose shapes and residual terms are complex. imaginary holds the
 * imaginary parts of shapes, residual terms and residual modes at contact and probes. The rest of
 * it is NULL, its sizes are 0. NULL: real. */
shb_status modal_model_write_complex_at(hid_t at, const modal_model *model,
                                        const modal_model *imaginary);
shb_status modal_model_read_complex_at(hid_t at, const char *path, modal_model *model,
                                       modal_model *imaginary);

/* Read complex data whose imaginary parts must vanish. SHB_ERR_INPUT: one does not. */
shb_status modal_model_read_real_at(hid_t at, const char *path, modal_model *model);

/* The response to the load, of the model's sizes: its datasets below the group backward. */
shb_status modal_model_write_backward_at(hid_t at, const modal_model *model,
                                         const modal_model *loads);
/* loads <- from there; without the group the conjugate of the model's own load. loads is zeroed
 * before the call and freed by the caller in any case. */
shb_status modal_model_read_backward_at(hid_t at, const modal_model *model, modal_model *loads);

/* Read and check a modal file, whatever program wrote it; of nodal diameters, that of 0. Errors:
 * SHB_ERR_IO missing, not HDF5, or truncated; SHB_ERR_INPUT foreign format, missing dataset, wrong
 * shape, value not finite, frequency not positive or descending, damping outside [0, 1). */
shb_status modal_model_read(const char *path, modal_model *model);

/* Free the residual matrices from a term on (0 R, 1 R2, 2 R3). Their diagonals are kept, for the
 * error estimate of the series. All that is made of the matrices must be made before. Nothing
 * happens without all three of them. */
void modal_model_release_terms(modal_model *model, int first);

void modal_model_free(modal_model *model);

#endif
