#include "mhb/floquet/hessenberg_qr.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "mhb/variation/ring_band.h"

/* QR steps an eigenvalue at most, and how often one takes an exceptional shift. */
enum { MOST_STEPS = 40, EXCEPTIONAL = 10 };

void mhb_hessenberg_qr_create(int capacity, mhb_hessenberg_qr *qr) {
  size_t n = (size_t)capacity, wide = (n + MHB_COLUMNS) * n;
  *qr          = (mhb_hessenberg_qr){.capacity = capacity, .size = 34 * capacity + 1};
  qr->re       = shb_arena_take(&qr->arena, wide, sizeof(double));
  qr->im       = shb_arena_take(&qr->arena, wide, sizeof(double));
  qr->c        = shb_arena_take(&qr->arena, n, sizeof(double));
  qr->s_re     = shb_arena_take(&qr->arena, n, sizeof(double));
  qr->s_im     = shb_arena_take(&qr->arena, n, sizeof(double));
  qr->panel_re = shb_arena_take(&qr->arena, n + 1, sizeof(mhb_columns));
  qr->panel_im = shb_arena_take(&qr->arena, n + 1, sizeof(mhb_columns));
  qr->scale    = shb_arena_take(&qr->arena, n, sizeof(double));
  qr->tau      = shb_arena_take(&qr->arena, n, sizeof *qr->tau);
  qr->work     = shb_arena_take(&qr->arena, (size_t)qr->size, sizeof *qr->work);
}

void mhb_hessenberg_qr_destroy(mhb_hessenberg_qr *qr) {
  shb_arena_free(&qr->arena);
  *qr = (mhb_hessenberg_qr){0};
}

static double complex entry(const mhb_hessenberg_qr *qr, int n, int row, int column) {
  return CMPLX(qr->re[column * n + row], qr->im[column * n + row]);
}

/* Balance, reduce to Hessenberg form, split into real and imaginary parts. */
static int reduce(mhb_hessenberg_qr *qr, int n, double complex *A) {
  int low, high;
  if (LAPACKE_zgebal_work(LAPACK_COL_MAJOR, 'B', n, A, n, &low, &high, qr->scale) != 0 ||
      LAPACKE_zgehrd_work(LAPACK_COL_MAJOR, n, low, high, A, n, qr->tau, qr->work, qr->size) != 0)
    return 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      int inside        = i <= j + 1;
      qr->re[j * n + i] = inside ? creal(A[j * n + i]) : 0;
      qr->im[j * n + i] = inside ? cimag(A[j * n + i]) : 0;
    }
  return 1;
}

/* The eigenvalue of the last two rows and columns that is nearer to the last element. */
static double complex wilkinson_shift(const mhb_hessenberg_qr *qr, int n, int last) {
  double complex a = entry(qr, n, last - 1, last - 1), d = entry(qr, n, last, last);
  double complex bc   = entry(qr, n, last - 1, last) * entry(qr, n, last, last - 1);
  double complex half = 0.5 * (a - d), root = csqrt(half * half + bc);
  if (creal(half) * creal(root) + cimag(half) * cimag(root) < 0) root = -root;
  double complex away = half + root;
  return away == 0 ? d : d - bc / away;
}

static void add_to_diagonal(mhb_hessenberg_qr *qr, int n, int first, int last, double complex by) {
  for (int i = first; i <= last; i++) {
    qr->re[i * n + i] += creal(by);
    qr->im[i * n + i] += cimag(by);
  }
}

/* Rotation k, by which rows k and k + 1 of a column (x, y) become (r, 0); y is real or complex. */
static void set_rotation(mhb_hessenberg_qr *qr, int k, double *x_re, double *x_im, double *y_re,
                         double *y_im) {
  double x = sqrt(*x_re * *x_re + *x_im * *x_im), y2 = *y_re * *y_re + *y_im * *y_im;
  double r = sqrt(x * x + y2);
  if (!(r > 0)) {
    qr->c[k]    = 1;
    qr->s_re[k] = qr->s_im[k] = 0;
    return;
  }
  /* of x, or 1 if it is 0: r keeps it, so that c is real */
  double u_re = x > 0 ? *x_re / x : 1, u_im = x > 0 ? *x_im / x : 0;
  qr->c[k]    = x / r;
  qr->s_re[k] = (u_re * *y_re + u_im * *y_im) / r; /* u conj(y)/r */
  qr->s_im[k] = (u_im * *y_re - u_re * *y_im) / r;
  *x_re       = u_re * r;
  *x_im       = u_im * r;
  *y_re = *y_im = 0;
}

/* Rotations first..end - 1 on the columns of the panel, rows from `first` on. */
MHB_HOT static void rotate_panel(const mhb_hessenberg_qr *qr, int first, int end) {
  mhb_columns *re = (mhb_columns *)qr->panel_re, *im = (mhb_columns *)qr->panel_im;
  mhb_columns  x_re = re[first], x_im = im[first];
  for (int k = first; k < end; k++) {
    double      c = qr->c[k], s = qr->s_re[k], t = qr->s_im[k];
    mhb_columns y_re = re[k + 1], y_im = im[k + 1];
    re[k] = c * x_re + s * y_re - t * y_im;
    im[k] = c * x_im + s * y_im + t * y_re;
    /* y <- c y - conj(s) x */
    mhb_columns next = c * y_re - s * x_re - t * x_im;
    x_im             = c * y_im - s * x_im + t * x_re;
    x_re             = next;
  }
  re[end] = x_re;
  im[end] = x_im;
}

/* One rotation on one column of the panel. */
static void rotate_one(const mhb_hessenberg_qr *qr, int k, int lane) {
  double *re = qr->panel_re + k * MHB_COLUMNS + lane, *im = qr->panel_im + k * MHB_COLUMNS + lane;
  double  c = qr->c[k], s = qr->s_re[k], t = qr->s_im[k];
  double  x_re = re[0], x_im = im[0], y_re = re[MHB_COLUMNS], y_im = im[MHB_COLUMNS];
  re[0]           = c * x_re + s * y_re - t * y_im;
  im[0]           = c * x_im + s * y_im + t * y_re;
  re[MHB_COLUMNS] = c * y_re - s * x_re - t * x_im;
  im[MHB_COLUMNS] = c * y_im - s * x_im + t * x_re;
}

/* Rows first..end - 1 of up to MHB_COLUMNS columns, to the panel or back. */
static void move_panel(mhb_hessenberg_qr *qr, int n, int column, int columns, int first, int end,
                       int back) {
  for (int l = 0; l < columns; l++) {
    double *re = qr->re + (column + l) * n, *im = qr->im + (column + l) * n;
    for (int i = first; i < end; i++) {
      int at = i * MHB_COLUMNS + l;
      if (back) {
        re[i] = qr->panel_re[at];
        im[i] = qr->panel_im[at];
      } else {
        qr->panel_re[at] = re[i];
        qr->panel_im[at] = im[i];
      }
    }
  }
}

/* H <- R of the active rows and columns first..last. */
static void triangularise(mhb_hessenberg_qr *qr, int n, int first, int last) {
  for (int column = first; column <= last; column += MHB_COLUMNS) {
    int columns = last + 1 - column < MHB_COLUMNS ? last + 1 - column : MHB_COLUMNS;
    int end     = column + columns < last ? column + columns + 1 : last + 1;
    move_panel(qr, n, column, columns, first, end, 0);
    if (column > first) rotate_panel(qr, first, column);
    for (int l = 0; l < columns; l++) {
      int k = column + l;
      for (int i = column; i < k; i++) rotate_one(qr, i, l);
      if (k == last) continue;
      double *re = qr->panel_re + k * MHB_COLUMNS + l, *im = qr->panel_im + k * MHB_COLUMNS + l;
      set_rotation(qr, k, re, im, re + MHB_COLUMNS, im + MHB_COLUMNS);
    }
    move_panel(qr, n, column, columns, first, end, 1);
  }
}

/* Rotation by (c, s, t) of two columns from the right. */
MHB_HOT static void rotate_columns(int rows, double c, double s, double t, double *restrict x_re,
                                   double *restrict x_im, double *restrict y_re,
                                   double *restrict y_im) {
  for (int i = 0; i < rows; i++) {
    double a = x_re[i], b = x_im[i], d = y_re[i], e = y_im[i];
    x_re[i] = c * a + s * d + t * e; /* c x + conj(s) y */
    x_im[i] = c * b + s * e - t * d;
    y_re[i] = c * d - s * a + t * b; /* c y - s x */
    y_im[i] = c * e - s * b - t * a;
  }
}

static void qr_step(mhb_hessenberg_qr *qr, int n, int first, int last, double complex shift) {
  add_to_diagonal(qr, n, first, last, -shift);
  triangularise(qr, n, first, last);
  for (int k = first; k < last; k++) {
    int x = k * n + first, y = x + n;
    rotate_columns(k + 2 - first, qr->c[k], qr->s_re[k], qr->s_im[k], qr->re + x, qr->im + x,
                   qr->re + y, qr->im + y);
  }
  add_to_diagonal(qr, n, first, last, shift);
}

static double size_of(const mhb_hessenberg_qr *qr, int n, int row, int column) {
  return fabs(qr->re[column * n + row]) + fabs(qr->im[column * n + row]);
}

/* First row of the active block that ends at last. Negligible elements become 0. */
static int active_block(mhb_hessenberg_qr *qr, int n, int last) {
  for (int k = last; k > 0; k--) {
    double beside = size_of(qr, n, k - 1, k - 1) + size_of(qr, n, k, k);
    if (size_of(qr, n, k, k - 1) > DBL_EPSILON * beside + DBL_MIN) continue;
    qr->re[(k - 1) * n + k] = qr->im[(k - 1) * n + k] = 0;
    return k;
  }
  return 0;
}

int mhb_hessenberg_qr_eigenvalues(mhb_hessenberg_qr *qr, int n, double complex *A,
                                  double complex *value) {
  if (!reduce(qr, n, A)) return 0;
  int steps = 0;
  for (int last = n - 1; last >= 0;) {
    int first = active_block(qr, n, last);
    if (first == last) {
      value[last] = entry(qr, n, last, last);
      last--;
      steps = 0;
      continue;
    }
    if (++steps > MOST_STEPS) return 0;
    double complex shift = wilkinson_shift(qr, n, last);
    if (steps % EXCEPTIONAL == 0) shift = entry(qr, n, last, last) + size_of(qr, n, last, last - 1);
    qr_step(qr, n, first, last, shift);
  }
  return 1;
}
