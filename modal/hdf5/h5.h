/* Thin layer over HDF5: whole datasets with units, names and one-line errors. HDF5's own error
 * stack is not printed.
 *
 * Complex numbers are compounds {r, i} of doubles. Every dataset gets the attributes units and
 * long_name. Datasets are contiguous; large ones that are mostly zero are compressed. */
#ifndef MODAL_HDF5_H5_H
#define MODAL_HDF5_H5_H

#include <complex.h>
#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

#include "mesh/base/publish.h"
#include "mesh/base/status.h"

enum { H5_MAX_RANK = 5 };

/* Shape of a dataset. rank 0: scalar. */
typedef struct {
  int     rank;
  hsize_t dim[H5_MAX_RANK];
} h5_shape;

#define H5_SHAPE(...) \
  ((h5_shape){(int)(sizeof((hsize_t[]){__VA_ARGS__}) / sizeof(hsize_t)), {__VA_ARGS__}})

size_t h5_count(h5_shape shape); /* number of elements */

/* Create a file (truncating an old one), or open one for reading. A created file is built in
 * memory. h5_close writes it to the disk, behind a checksum. A file that was changed since is
 * opened with a warning on standard error. A crash of HDF5 while files are open for reading ends
 * the process with one line. Errors: SHB_ERR_IO; SHB_ERR_INPUT if content of the file lies in
 * another one. The text says whether the file is missing, unreadable, not HDF5, or truncated. */
shb_status h5_create(const char *path, hid_t *file);
shb_status h5_open(const char *path, hid_t *file);
/* Create a file that begins with the content of an earlier one, which this program wrote and nobody
 * changed since. Errors: as h5_create; SHB_ERR_INPUT if the earlier file is not intact. */
shb_status h5_create_like(const char *earlier, const char *path, hid_t *file);
/* Whether an earlier result at path can be opened without a crash. It fits its stamp
 * (modal/hdf5/stamp.h), or has none and a child process could read it. SHB_OK too if there is no
 * file. SHB_ERR_IO: it is damaged, or was changed. */
shb_status h5_check_earlier(const char *path);
/* Write a created file to the disk and close it. Errors: SHB_ERR_IO if the file could not be
 * written whole; it is then removed. The handle is closed in any case. A negative handle does
 * nothing. */
shb_status h5_close(hid_t file);
/* Close without writing and remove a created file, after an error. */
void h5_abandon(hid_t file);

/* Create the file beside path, let fill write it, and publish it whole (mesh/base/publish.h). An
 * earlier file stays as it is after an error. Errors: of fill, h5_create, h5_close, shb_publish. */
typedef shb_status (*h5_fill)(hid_t file, const void *context);
shb_status h5_publish(const char *path, h5_fill fill, const void *context);
/* The same beginning with the content of an earlier file (h5_create_like), which may be at path. */
shb_status h5_publish_like(const char *earlier, const char *path, h5_fill fill,
                           const void *context);

/* Write dataset path below at. Groups in between are created. data: row-major, of the given shape.
 * Errors: SHB_ERR_IO; SHB_ERR_INPUT if a value is not finite, since results that overflow come from
 * inputs that are too large. The text names the file, the dataset and the place. */
shb_status h5_write_double(hid_t at, const char *path, h5_shape shape, const double *data,
                           const char *units, const char *long_name);
/* The same in single precision. */
shb_status h5_write_single(hid_t at, const char *path, h5_shape shape, const float *data,
                           const char *units, const char *long_name);
shb_status h5_write_complex(hid_t at, const char *path, h5_shape shape, const double complex *data,
                            const char *units, const char *long_name);
shb_status h5_write_complex_single(hid_t at, const char *path, h5_shape shape,
                                   const float complex *data, const char *units,
                                   const char *long_name);
shb_status h5_write_int(hid_t at, const char *path, h5_shape shape, const int *data,
                        const char *units, const char *long_name);
/* Replace the values of a dataset of a created file. Its shape stays. Errors: as above; SHB_ERR_IO
 * if it is missing or has another shape. */
shb_status h5_replace_double(hid_t at, const char *path, h5_shape shape, const double *data);
shb_status h5_replace_complex(hid_t at, const char *path, h5_shape shape,
                              const double complex *data);
/* Write the numbers 0 .. n - 1, a dimension scale without data of its own. */
shb_status h5_write_counter(hid_t at, const char *path, hsize_t n, const char *long_name);
shb_status h5_write_strings(hid_t at, const char *path, int n, const char *const *text,
                            const char *long_name);
shb_status h5_write_attribute_text(hid_t at, const char *path, const char *name, const char *text);
shb_status h5_write_attribute_double(hid_t at, const char *path, const char *name, double value);
shb_status h5_write_attribute_int(hid_t at, const char *path, const char *name, int value);
/* Attach a dimension scale (an existing 1D dataset) to dimension dim of path. */
shb_status h5_attach_scale(hid_t at, const char *path, int dim, const char *scale_path);
/* Write the root attributes format, format_version, revision, command, case_path, case_text,
 * settings and created (ISO 8601, UTC). */
shb_status h5_write_provenance(hid_t file, const char *format, int version,
                               const shb_provenance *provenance);

bool       h5_exists(hid_t at, const char *path);
shb_status h5_shape_of(hid_t at, const char *path, h5_shape *shape);
/* Read a whole dataset into malloc'ed memory.
 *
 *   expected  in   rank, and the dimensions that must hold (0: any)
 *             out  the actual shape
 *
 * Real data is accepted where complex is expected. Errors: SHB_ERR_INPUT if the dataset is missing,
 * has another rank or shape, or holds a number that is not finite. The text names the file, the
 * dataset, the found and the wanted shape. */
shb_status h5_check_shape(hid_t at, const char *path, h5_shape *expected); /* reads no value */
shb_status h5_read_double(hid_t at, const char *path, h5_shape *expected, double **data);
shb_status h5_read_complex(hid_t at, const char *path, h5_shape *expected, double complex **data);
shb_status h5_read_int(hid_t at, const char *path, h5_shape *expected, int **data);
shb_status h5_read_strings(hid_t at, const char *path, int *n, char ***text);
/* Read an attribute's text, malloc'ed; *text = NULL if it is absent. */
shb_status h5_read_attribute_text(hid_t at, const char *path, const char *name, char **text);
/* Read a number; *value = fallback if it is absent. */
shb_status h5_read_attribute_double(hid_t at, const char *path, const char *name, double fallback,
                                    double *value);
shb_status h5_read_attribute_int(hid_t at, const char *path, const char *name, int fallback,
                                 int *value);
/* A list of whole numbers, malloc'ed also after an error; *n = 0 and NULL if it is absent. */
shb_status h5_write_attribute_ints(hid_t at, const char *path, const char *name, int n,
                                   const int *value);
shb_status h5_read_attribute_ints(hid_t at, const char *path, const char *name, int *n,
                                  int **value);
/* SHB_ERR_INPUT unless the attribute format is as wanted and format_version is at most version. */
shb_status h5_check_format(hid_t file, const char *format, int version);

#endif
