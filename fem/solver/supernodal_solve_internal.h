/* How the kernels of the supernodal solves are compiled: once for AVX2, once for any processor. */
#ifndef FEM_SOLVER_SUPERNODAL_SOLVE_INTERNAL_H
#define FEM_SOLVER_SUPERNODAL_SOLVE_INTERNAL_H

/* clang 14 gives the clones a name that other files cannot link. */
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define FEM_HOT __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define FEM_HOT
#endif
#define FEM_KERNEL static inline __attribute__((always_inline))

#endif
