/* fclib_solve FILE TOLERANCE: solves the local frictional contact problem that an FCLIB file holds by
   Siconos' nonsmooth Gauss-Seidel method, and writes the solution into the file. Exit code 1 where it does
   not converge. */
#include <stdio.h>
#include <stdlib.h>

#include <fclib.h>

#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>

/* Columns one after another; nz = -2: the file has compressed rows. */
static double *dense(const struct fclib_matrix *sparse) {
  double *values = calloc((size_t)sparse->m * (size_t)sparse->n, sizeof *values);
  if (!values || sparse->nz != -2) exit(2);
  for (int row = 0; row < sparse->m; ++row) {
    for (int k = sparse->p[row]; k < sparse->p[row + 1]; ++k) {
      values[row + (size_t)sparse->i[k] * (size_t)sparse->m] = sparse->x[k];
    }
  }
  return values;
}

int main(int count, char **words) {
  if (count != 3) return 2;
  struct fclib_local *file = fclib_read_local(words[1]);
  if (!file) return 2;
  const int size = file->W->m;
  NumericsMatrix *matrix = NM_create_from_data(NM_DENSE, size, size, dense(file->W));
  FrictionContactProblem *problem =
      frictionContactProblem_new_with_data(file->spacedim, size / file->spacedim, matrix, file->q, file->mu);
  SolverOptions *options = solver_options_create(SICONOS_FRICTION_3D_NSGS);
  options->dparam[SICONOS_DPARAM_TOL] = atof(words[2]);
  options->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
  double *reaction = calloc((size_t)size, sizeof *reaction);
  double *velocity = calloc((size_t)size, sizeof *velocity);
  const int failed = fc3d_driver(problem, reaction, velocity, options);
  printf("%d sweeps, error %.3g\n", options->iparam[SICONOS_IPARAM_ITER_DONE], options->dparam[SICONOS_DPARAM_RESIDU]);
  struct fclib_solution solution = {.v = NULL, .u = velocity, .r = reaction, .l = NULL};
  if (!fclib_write_solution(&solution, words[1])) return 2;
  return failed != 0;
}
