/* Room behind arrays that OpenBLAS reads beyond their end. */
#ifndef MHB_NUMERICS_BLAS_ROOM_H
#define MHB_NUMERICS_BLAS_ROOM_H

/* Numbers of room. zgemv of OpenBLAS 0.3.21 reads one number of a vector too many where the matrix
 * has 4 i + 2 rows. In LAPACK's complex routines that vector is the row of a matrix, and the number
 * lies a row further. A read behind the heap is a crash.
 *
 * So LAPACK takes complex matrices as they stand, by columns. A transposed copy that LAPACKE makes
 * would have no room behind it. */
enum { MHB_BLAS_ROOM = 1024 };

#endif
