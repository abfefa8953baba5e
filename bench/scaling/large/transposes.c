/* transposes N: what slabs of rows send in one application of the tangential operator on N x N cells, counted. Each of the
   two fields' half-plane of N x (N + 1) complex numbers is transposed by FFTW's MPI library, and back. Prints JSON.
   mpicc transposes.c -o transposes -lfftw3_mpi -lfftw3 -lm && mpirun -n P transposes N */
#include <fftw3-mpi.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

static double bytes = 0.0;   /* to other ranks */
static double messages = 0.0;

static void count(MPI_Comm comm, int to, double amount, MPI_Datatype type) {
  int rank, size;
  MPI_Comm_rank(comm, &rank);
  MPI_Type_size(type, &size);
  if (to == rank || amount == 0.0) return;
  bytes += amount * size;
  messages += 1.0;
}

/* In the place of the library's own: FFTW calls these. */
int MPI_Alltoall(const void *in, int sent, MPI_Datatype type, void *out, int received, MPI_Datatype other, MPI_Comm comm) {
  int ranks;
  MPI_Comm_size(comm, &ranks);
  for (int to = 0; to < ranks; ++to) count(comm, to, sent, type);
  return PMPI_Alltoall(in, sent, type, out, received, other, comm);
}

int MPI_Alltoallv(const void *in, const int *sent, const int *from, MPI_Datatype type, void *out, const int *received,
                  const int *places, MPI_Datatype other, MPI_Comm comm) {
  int ranks;
  MPI_Comm_size(comm, &ranks);
  for (int to = 0; to < ranks; ++to) count(comm, to, sent[to], type);
  return PMPI_Alltoallv(in, sent, from, type, out, received, places, other, comm);
}

int MPI_Sendrecv(const void *in, int sent, MPI_Datatype type, int to, int tag, void *out, int received, MPI_Datatype other,
                 int from, int other_tag, MPI_Comm comm, MPI_Status *status) {
  count(comm, to, sent, type);
  return PMPI_Sendrecv(in, sent, type, to, tag, out, received, other, from, other_tag, comm, status);
}

int main(int argc, char **argv) {
  MPI_Init(&argc, &argv);
  fftw_mpi_init();
  const ptrdiff_t n = argc > 1 ? atol(argv[1]) : 64, half = n + 1, complex_number = 2, fields = 2;
  ptrdiff_t rows, first_row, columns, first_column;
  const ptrdiff_t local = fftw_mpi_local_size_many_transposed(2, (ptrdiff_t[]){n, half}, complex_number, FFTW_MPI_DEFAULT_BLOCK,
                                                              FFTW_MPI_DEFAULT_BLOCK, MPI_COMM_WORLD, &rows, &first_row,
                                                              &columns, &first_column);
  double *plane = fftw_alloc_real(local > 0 ? local : 1);
  fftw_plan there = fftw_mpi_plan_many_transpose(n, half, complex_number, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, plane,
                                                 plane, MPI_COMM_WORLD, FFTW_ESTIMATE);
  fftw_plan back = fftw_mpi_plan_many_transpose(half, n, complex_number, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, plane,
                                                plane, MPI_COMM_WORLD, FFTW_ESTIMATE);
  bytes = messages = 0.0;
  for (ptrdiff_t field = 0; field < fields; ++field) {
    fftw_execute(there);
    fftw_execute(back);
  }
  double own[3] = {bytes, messages, sizeof(double) * (double)local}, all[3], largest[3];
  int ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PMPI_Reduce(own, all, 3, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  PMPI_Reduce(own, largest, 3, MPI_DOUBLE, MPI_MAX, 0, MPI_COMM_WORLD);
  if (rank == 0) {
    printf("{\"cells\": %td, \"ranks\": %d, \"bytes\": %.0f, \"messages\": %.0f, \"largest_rank_bytes\": %.0f}\n", n, ranks,
           all[0], all[1], largest[0]);
  }
  fftw_destroy_plan(there);
  fftw_destroy_plan(back);
  fftw_free(plane);
  MPI_Finalize();
  return 0;
}
