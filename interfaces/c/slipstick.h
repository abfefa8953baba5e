/* slipstick: exact and numerical solutions of the elastic torsional contact with slip and stick, for programs
 * in any language.
 *
 * A function with the result int returns a value of enum slipstick_status; slipstick_message() returns the
 * message of an error. The caller owns the arrays that it passes; the library owns the arrays and texts that
 * it returns, until slipstick_solution_free(). All functions may be called by several threads at the same
 * time, and several threads may read one solution. No exception leaves a function. Texts are UTF-8 and end
 * with a zero byte.
 *
 * Exact states are dimensionless: lengths are divided by the contact radius a, moments by mu W a, tractions
 * by mu p0, energies by (mu W)^2/(G a); the twist is G a^2 phi/(mu W), with 1/G = 1/G_1 + 1/G_2 of the two
 * bodies. Solutions of scenes are in SI units, angles in rad. */
#ifndef SLIPSTICK_H
#define SLIPSTICK_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum slipstick_status {
  SLIPSTICK_OK = 0,
  SLIPSTICK_NOT_CONVERGED = 1, /* there is a solution; the message says what it did not reach */
  SLIPSTICK_BAD_INPUT = 2,     /* the message names the mistake and the allowed values */
  SLIPSTICK_STOPPED = 3,       /* the caller's progress function stopped the solve */
  SLIPSTICK_NO_MEMORY = 4,
  SLIPSTICK_FAILED = 5 /* a thread could not start, or a mistake in the library */
};

/* the version by SemVer, for example "1.0.0" */
const char* slipstick_version(void);

/* The message of the calling thread's last call that did not return SLIPSTICK_OK; at most 4,095 bytes. */
const char* slipstick_message(void);

/* Exact states of an axisymmetric contact in torsion, without a grid.
 *
 * A profile describes its pressure: "hertz" (sphere), "cone", "flat_punch", "power:N" (gap like r^N),
 * "rounded_punch:B" (flat out to B = b/a), "file:P.csv" (columns radius, pressure). */

enum slipstick_quantity {
  SLIPSTICK_MOMENT_RATIO = 0,      /* M/M_lim, in [0, 1) */
  SLIPSTICK_MOMENT_DEFICIT = 1,    /* 1 - M/M_lim, in (0, 1] */
  SLIPSTICK_STICK_RATIO = 2,       /* a_s/a, in (0, 1] */
  SLIPSTICK_STICK_COMPLEMENT = 3,  /* 1 - a_s/a, in [0, 1) */
  SLIPSTICK_TWIST = 4,             /* G a^2 phi/(mu W), from 0 */
  SLIPSTICK_MOMENT = 5,            /* M/(mu W a); this and the following are results only */
  SLIPSTICK_TANGENT_STIFFNESS = 6, /* (dM/dphi)/(G a^3) */
  SLIPSTICK_ENERGY_LOST = 7        /* in a cycle between M and -M, over (mu W)^2/(G a) */
};

/* results[i]: the quantity `wanted` of the state of first loading at which the quantity `given` (0 to 4) is
 * values[i]. Both arrays have n numbers; they may be the same one. A value that is NaN or out of range
 * ends the call; the message gives its index, and results after it are unchanged. */
int slipstick_exact(const char* profile, int given, size_t n, const double* values, int wanted, double* results);

/* All quantities except the energy. */
typedef struct slipstick_state {
  double moment_ratio;
  double moment_deficit;
  double stick_ratio;
  double stick_complement;
  double twist;
  double moment;
  double tangent_stiffness;
} slipstick_state;
int slipstick_exact_states(const char* profile, int given, size_t n, const double* values, slipstick_state* states);

/* As slipstick_exact with SLIPSTICK_ENERGY_LOST, to a relative error from 1e-14 (its own) to below 1: a
 * larger one takes a tenth of the time for profiles without a closed form. */
int slipstick_exact_energy_lost(const char* profile, int given, size_t n, const double* values, double relative_error,
                                double* results);

/* results[i]: the traction q/(mu p0) around the axis at radius r/a = radii[i] in [0, 1], for the state at
 * which `given` is `value`. The edge of a flat punch, where it is infinite, is refused. */
int slipstick_exact_traction(const char* profile, int given, double value, size_t n, const double* radii,
                             double* results);

/* results[i]: p/p0 at radius r/a = radii[i] in [0, 1]; infinite if the profile's pressure is. */
int slipstick_exact_pressure(const char* profile, size_t n, const double* radii, double* results);

/* Dimensionless constants of a profile. */
typedef struct slipstick_profile {
  double load;         /* W/(p0 a^2) */
  double moment_limit; /* M_lim/(mu W a): 3 pi/16 for a sphere */
  double full_stick;   /* M/M_lim below which nothing slips: 0 unless the pressure is infinite at the edge */
} slipstick_profile;
int slipstick_exact_profile(const char* profile, slipstick_profile* result);

/* The state of a contact after a history of moments, at constant normal load. */
typedef struct slipstick_cycle_state {
  double moment_ratio;      /* M/M_lim, signed */
  double moment;            /* M/(mu W a) */
  double twist;             /* G a^2 phi/(mu W) */
  double stick_ratio;       /* front of the newest branch's slip, over a */
  double tangent_stiffness; /* (dM/dphi)/(G a^3) of further loading */
  double dissipated;        /* since the first loading began, over (mu W)^2/(G a) */
} slipstick_cycle_state;

/* states[i]: the state after the moments moment_ratios[0] to moment_ratios[i], each in (-1, 1), starting from
 * zero. */
int slipstick_exact_history(const char* profile, size_t n, const double* moment_ratios, slipstick_cycle_state* states);

/* The curve through these turning points, from the unloaded state: n * points_per_branch + 1 states, which
 * are closer to each other near the ends of a branch. */
int slipstick_exact_curve(const char* profile, size_t n, const double* turning_points, size_t points_per_branch,
                          slipstick_cycle_state* states);

/* results[i]: the signed traction q/(mu p0) at radii[i] after the n_moments moments. */
int slipstick_exact_history_traction(const char* profile, size_t n_moments, const double* moment_ratios, size_t n_radii,
                                     const double* radii, double* results);

/* Stresses below the surface, along r, theta and the outward normal z: tz is the traction q at the surface.
 * By the pressure over p0, by the torsion (rt, tz) over mu p0; the last three of both together, over p0. */
typedef struct slipstick_stress {
  double rr;
  double tt;
  double zz;
  double rz;
  double rt;
  double tz;
  double von_mises; /* equivalent tensile stress */
  double tresca;    /* largest less smallest principal stress */
  double tension;   /* largest principal stress */
} slipstick_stress;

/* results[i]: at r/a = radii[i], depth z/a = depths[i]. The state: `given` is values[0]; several values of
 * SLIPSTICK_MOMENT_RATIO are a history of moments. NaN for stresses by a pressure that the profile does not
 * know. */
int slipstick_exact_stresses(const char* profile, int given, size_t n_values, const double* values, double friction,
                             double poisson, size_t n, const double* radii, const double* depths,
                             slipstick_stress* results);

/* The largest stress in the body, over p0, and where it is. measure: 0 von Mises, 1 Tresca, 2 tension. Fails
 * where a stress is infinite or not known. */
typedef struct slipstick_largest_stress {
  double value;
  double radius; /* r/a */
  double depth;  /* z/a */
} slipstick_largest_stress;
int slipstick_exact_largest_stress(const char* profile, int given, size_t n_values, const double* values,
                                   double friction, double poisson, int measure, slipstick_largest_stress* result);

/* The contact under a normal load, in SI units. shape: "hertz": sphere radius; "cone": slope;
 * "flat_punch": radius; "power:N": the gap's coefficient; "rounded_punch": flat radius, corner radius. */
typedef struct slipstick_indentation {
  double contact_radius;     /* a, m */
  double approach;           /* m */
  double reference_pressure; /* p0, Pa */
} slipstick_indentation;
int slipstick_exact_indentation(const char* profile, double load, double effective_modulus, size_t n_shape,
                                const double* shape, slipstick_indentation* result);

/* Scenes, solved on a grid or exactly. */

/* The solving thread calls it during the solve of the pressure and then of the tractions, with the number of
 * iterations or applications and the value of the stopping test. A result other than 0 stops the solve. The
 * function must not throw, nor leave by longjmp. */
typedef int (*slipstick_progress)(int iteration, double change, void* user);

/* A scene's answer. */
typedef struct slipstick_solution slipstick_solution;

/* Solves a scene (docs/reference/scene.md). scene: its text (TOML); `file` is then its name in messages, to
 * which its paths are relative (NULL: "scene"). If scene is NULL, `file` is read. overrides: `n_overrides`
 * texts "key=value". accuracy: the relative error of the twist to reach, by a choice of cells, tolerance and
 * model; 0: the scene is solved unchanged. progress may be NULL. *solution is NULL unless the status is
 * SLIPSTICK_OK or SLIPSTICK_NOT_CONVERGED (which also means that the accuracy was not reached). */
int slipstick_solve(const char* scene, const char* file, size_t n_overrides, const char* const* overrides,
                    double accuracy, slipstick_progress progress, void* user, slipstick_solution** solution);
void slipstick_solution_free(slipstick_solution* solution); /* NULL is allowed */

/* A number of the result by its path, for example "twist_angle" or "steps[3].traction_error.l2":
 * docs/reference/results.md. For a number that does not exist, value is NaN, the status SLIPSTICK_BAD_INPUT,
 * and the message gives the reason. */
int slipstick_solution_number(const slipstick_solution* solution, const char* path, double* value);

/* The whole result as JSON, and as text like the program's output. */
const char* slipstick_solution_json(const slipstick_solution* solution);
const char* slipstick_solution_text(const slipstick_solution* solution);

/* Cells of the grid along x1 and x2, and their size in m. An exact answer without fields has none. */
int slipstick_solution_grid(const slipstick_solution* solution, size_t cells[2], double cell_size[2]);

/* A field: one number a cell, cell (i, j) at i * cells[1] + j. x1, x2 (m), pressure, q1, q2 (Pa, on the lower
 * body), slip1, slip2 (m, of the last step), stick (1 or 0), dissipated (J/m^2), pressure_sharpened,
 * q1_sharpened, q2_sharpened (Pa), q1_exact, q2_exact (if known); an exact answer has no slips.
 * "steps[3].q1": at the end of an earlier step of a history, counted from 0. Those from x1 to dissipated are
 * kept of all steps, if they take at most 512 MiB. Valid until the solution is freed. */
int slipstick_solution_field(const slipstick_solution* solution, const char* name, const double** values,
                             size_t* count);

/* The name of field number `index`, counted from 0; NULL beyond the last. */
const char* slipstick_solution_field_name(const slipstick_solution* solution, size_t index);

/* Writes all fields of the cells with pressure: .csv, .h5, .vti. */
int slipstick_solution_write(const slipstick_solution* solution, const char* file);

#ifdef __cplusplus
}
#endif

#endif
