/* Parts of VTKHDF files: datasets of any type, the header, names. Source: VTKHDF file format. */
#ifndef POSTPROC_FIELD_VTK_FILE_H
#define POSTPROC_FIELD_VTK_FILE_H

#include <hdf5.h>

#include "modal/hdf5/h5.h"

/* Attributes Version and Type UnstructuredGrid of the group VTKHDF. */
shb_status post_vtk_header(hid_t group, int major, int minor);

/* Create a dataset [rows], or [rows][columns] if columns is not 0, and groups in between. Negative
 * after an error. */
hid_t post_vtk_dataset(hid_t at, const char *name, hid_t type, hsize_t rows, hsize_t columns);

/* The same with its values. Errors, here and below: SHB_ERR_IO. */
shb_status post_vtk_array(hid_t at, const char *name, hid_t type, hsize_t rows, hsize_t columns,
                          const void *data);
/* One number as a dataset [1]. */
shb_status post_vtk_count(hid_t at, const char *name, long long count);
/* n = 0: a scalar. */
shb_status post_vtk_attribute(hid_t at, const char *name, hid_t type, hsize_t n, const void *data);

/* units and long_name of the datasets that exist: rows of name, units, long name. */
shb_status post_vtk_describe(hid_t group, int n, const char *const text[][3]);

/* Records that a part of the file could not be written; SHB_ERR_IO. */
shb_status post_vtk_failed(const char *what);

#endif
