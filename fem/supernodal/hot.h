/* How kernels are compiled: once for AVX2, once for any processor. A kernel with FEM_HOT calls only
 * functions with FEM_KERNEL, and has no parallel region of its own. */
#ifndef FEM_SUPERNODAL_HOT_H
#define FEM_SUPERNODAL_HOT_H

/* clang 14 gives the clones a name that other files cannot link. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define FEM_HOT __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define FEM_HOT
#endif
#define FEM_KERNEL static inline __attribute__((always_inline))

#endif
