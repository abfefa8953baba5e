/* Calls every function of slipstick.h as a program in C does, and checks the promises of the header. The Python
 * package's tests check the facts of the theory through the same library. */
#define _POSIX_C_SOURCE 200809L

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "slipstick.h"

static int failures = 0;

static void check(int holds, const char* what) {
  if (holds) return;
  ++failures;
  printf("fails: %s (message: %s)\n", what, slipstick_message());
}

static int near(double value, double expected, double relative) {
  return fabs(value - expected) <= relative * fabs(expected);
}

static int says(const char* words) { return strstr(slipstick_message(), words) != NULL; }

static const double kPi = 3.14159265358979323846;

static double one(const char* profile, int given, double value, int wanted) {
  double result = NAN;
  check(slipstick_exact(profile, given, 1, &value, wanted, &result) == SLIPSTICK_OK, "an exact state");
  return result;
}

/* Lubkin (1951), Hertz (1882). */
static void test_constants(void) {
  slipstick_profile hertz;
  check(slipstick_exact_profile("hertz", &hertz) == SLIPSTICK_OK && near(hertz.load, 2 * kPi / 3, 1e-15) &&
            near(hertz.moment_limit, 3 * kPi / 16, 1e-15) && hertz.full_stick == 0,
        "the constants of a profile");
  slipstick_indentation contact;
  const double radius = 0.018, load = 1000, modulus = 115e9;
  check(slipstick_exact_indentation("hertz", load, modulus, 1, &radius, &contact) == SLIPSTICK_OK &&
            near(contact.approach, pow(contact.contact_radius, 2) / radius, 1e-13) &&
            near(contact.reference_pressure, 1.5 * load / (kPi * pow(contact.contact_radius, 2)), 1e-13),
        "Hertz's contact in m");
}

/* The members of a state are the quantities, in their order. */
static void test_states(const char* profile) {
  double ratios[3] = {0.9, 0.95, 0.999};
  slipstick_state states[3];
  check(slipstick_exact_states(profile, SLIPSTICK_MOMENT_RATIO, 3, ratios, states) == SLIPSTICK_OK, "states");
  for (int i = 0; i < 3; ++i) {
    const double members[7] = {states[i].moment_ratio,     states[i].moment_deficit, states[i].stick_ratio,
                               states[i].stick_complement, states[i].twist,          states[i].moment,
                               states[i].tangent_stiffness};
    for (int wanted = 0; wanted < 7; ++wanted)
      check(near(one(profile, SLIPSTICK_TWIST, states[i].twist, wanted), members[wanted], 1e-9), "a member");
  }
  check(slipstick_exact(profile, SLIPSTICK_MOMENT_RATIO, 3, ratios, SLIPSTICK_TWIST, ratios) == SLIPSTICK_OK &&
            ratios[2] == states[2].twist,
        "results may replace the values");
  double lost[3];
  check(slipstick_exact_energy_lost(profile, SLIPSTICK_TWIST, 3, ratios, 1e-3, lost) == SLIPSTICK_OK &&
            near(lost[2], one(profile, SLIPSTICK_TWIST, ratios[2], SLIPSTICK_ENERGY_LOST), 1e-3),
        "the energy lost to a given error");
  check(slipstick_exact_energy_lost(profile, SLIPSTICK_TWIST, 3, ratios, 0, lost) == SLIPSTICK_BAD_INPUT &&
            says("relative_error"),
        "no error at all");
}

/* A full reversal mirrors the state, and a cycle closes its loop: Masing's rule, exact here (Deresiewicz 1954). */
static void test_histories(const char* profile) {
  const double moments[3] = {0.95, -0.95, 0.95}, radius = 0.99;
  double pressure, traction, reversed;
  check(slipstick_exact_pressure(profile, 1, &radius, &pressure) == SLIPSTICK_OK, "a pressure");
  check(slipstick_exact_traction(profile, SLIPSTICK_MOMENT_RATIO, 0.95, 1, &radius, &traction) == SLIPSTICK_OK &&
            traction == pressure,
        "it slips at the edge");
  check(slipstick_exact_history_traction(profile, 2, moments, 1, &radius, &reversed) == SLIPSTICK_OK &&
            near(reversed, -traction, 1e-12),
        "a mirrored traction");
  slipstick_cycle_state states[3], curve[31];
  check(slipstick_exact_history(profile, 3, moments, states) == SLIPSTICK_OK &&
            near(states[2].twist, states[0].twist, 1e-12),
        "the loop closes");
  check(slipstick_exact_curve(profile, 3, moments, 10, curve) == SLIPSTICK_OK && curve[0].twist == 0 &&
            curve[30].twist == states[2].twist,
        "a curve runs from no load to the last turning point");
}

static void test_stresses(void) {
  const double value = 0.9, radius = 0, depth = 0.5;
  slipstick_stress stress;
  check(slipstick_exact_stresses("hertz", 0, 1, &value, 0.3, 0.3, 1, &radius, &depth, &stress) == SLIPSTICK_OK &&
            near(stress.zz, -0.8, 1e-14),
        "sigma_zz = -p0/(1 + z^2) on the axis");
  slipstick_largest_stress largest;
  check(slipstick_exact_largest_stress("hertz", 0, 1, &value, 0.0, 0.3, 1, &largest) == SLIPSTICK_OK &&
            near(largest.value, 0.62, 1e-3) && near(largest.depth, 0.481, 1e-3),
        "the largest Tresca stress of a sphere");
  check(slipstick_exact_largest_stress("hertz", 0, 1, &value, 0.0, 0.3, 3, &largest) == SLIPSTICK_BAD_INPUT,
        "a measure that does not exist");
}

static void test_refusals(void) {
  double values[3] = {0.5, 1.0, 0.5}, results[3] = {7, 7, 7};
  check(slipstick_exact("hertz", 0, 3, values, SLIPSTICK_TWIST, results) == SLIPSTICK_BAD_INPUT &&
            says("values[1]: M/M_lim = 1 is gross slip; allowed: 0 <= M/M_lim < 1"),
        "gross slip is refused, with its place");
  check(results[0] != 7 && results[1] == 7 && results[2] == 7, "results after it are as they were");
  const struct {
    const char* profile;
    int given;
    const double* values;
    int wanted;
    double* results;
    const char* words;
  } refused[] = {{"hertz", 5, values, 0, results, "given = 5"},
                 {"hertz", 0, values, 8, results, "wanted = 8"},
                 {NULL, 0, values, 0, results, "profile = NULL"},
                 {"hertz", 0, NULL, 0, results, "values = NULL"},
                 {"hertz", 0, values, 0, NULL, "results = NULL"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i)
    check(slipstick_exact(refused[i].profile, refused[i].given, 1, refused[i].values, refused[i].wanted,
                          refused[i].results) == SLIPSTICK_BAD_INPUT &&
              says(refused[i].words),
          refused[i].words);
  check(slipstick_exact("hertz", 0, 0, NULL, 0, NULL) == SLIPSTICK_OK, "an empty array may be NULL");
  values[0] = 1.5;
  check(slipstick_exact_pressure("hertz", 1, values, results) == SLIPSTICK_BAD_INPUT && says("radii[0]: r/a = 1.5"),
        "a radius beyond the edge");
  check(slipstick_exact_curve("hertz", 0, NULL, 0, NULL) == SLIPSTICK_BAD_INPUT, "a curve into nothing");
}

static const char* const kScene =
    "[upper]\nshape = \"sphere\"\nradius = 0.018\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n"
    "[lower]\nyoung_modulus = 210e9\npoisson_ratio = 0.3\n[contact]\nfriction = 0.1\n"
    "[load]\nnormal = 1000.0\nmoment_ratio = 0.9\n[grid]\ncells = [48, 48]\n";

static const char* const kExactModel = "solver.model=exact";

static slipstick_solution* solved(int status, double accuracy, size_t count, const char* const* overrides) {
  slipstick_solution* solution = NULL;
  check(slipstick_solve(kScene, "made.toml", count, overrides, accuracy, NULL, NULL, &solution) == status, "a solve");
  check((solution != NULL) == (status <= SLIPSTICK_NOT_CONVERGED), "there is a solution where it says so");
  return solution;
}

static double number(const slipstick_solution* solution, const char* path) {
  double value = NAN;
  check(slipstick_solution_number(solution, path, &value) == SLIPSTICK_OK, path);
  return value;
}

static const double* field(const slipstick_solution* solution, const char* name, size_t expected) {
  const double* values = NULL;
  size_t count = 0;
  check(slipstick_solution_field(solution, name, &values, &count) == SLIPSTICK_OK && count == expected, name);
  return values;
}

static void test_solution(void) {
  slipstick_solution* solution = solved(SLIPSTICK_OK, 0, 0, NULL);
  size_t cells[2];
  double size[2];
  check(slipstick_solution_grid(solution, cells, size) == SLIPSTICK_OK && cells[0] == 48 && cells[1] == 48, "cells");
  const double* p = field(solution, "pressure", 48 * 48);
  double load = 0;
  for (size_t i = 0; i < 48 * 48; ++i) load += p[i] * size[0] * size[1];
  check(near(load, 1000, 1e-9), "the pressure carries 1000 N");
  check(strstr(slipstick_solution_json(solution), "\"status\": \"converged\"") != NULL, "JSON");
  check(strstr(slipstick_solution_text(solution), "of the limit") != NULL, "text");
  size_t names = 0;
  while (slipstick_solution_field_name(solution, names) != NULL) ++names;
  check(names == 14 && strcmp(slipstick_solution_field_name(solution, 0), "x1") == 0, "fields have names");
  check(slipstick_solution_write(solution, "c_interface_test.csv") == SLIPSTICK_OK, "fields become a file");
  FILE* written = fopen("c_interface_test.csv", "r");
  char line[256] = "";
  check(written != NULL && fgets(line, sizeof line, written) != NULL && strncmp(line, "x1,x2,pressure,q1,q2", 20) == 0,
        "with a header");
  if (written != NULL) fclose(written);
  remove("c_interface_test.csv");

  slipstick_solution_free(solution);
  slipstick_solution_free(NULL);
}

/* Numbers, fields and formats that do not exist. */
static void test_refusals_of_a_solution(void) {
  slipstick_solution* exact = solved(SLIPSTICK_OK, 0, 1, &kExactModel);
  double value = 0;
  check(slipstick_solution_number(exact, "twist_angel", &value) == SLIPSTICK_BAD_INPUT && isnan(value) &&
            says("twist_angel"),
        "a number that does not exist");
  check(slipstick_solution_number(exact, "twist_error", &value) == SLIPSTICK_BAD_INPUT &&
            says("this is the exact answer"),
        "a number that is missing says why");
  const double* none = NULL;
  size_t nothing = 0;
  check(slipstick_solution_field(exact, "q3", &none, &nothing) == SLIPSTICK_BAD_INPUT && says("allowed: x1, x2"),
        "a field that does not exist");
  check(slipstick_solution_write(exact, "fields.txt") == SLIPSTICK_BAD_INPUT, "a format that does not exist");
  slipstick_solution_free(exact);
}

static int stop_at_once(int iteration, double change, void* user) {
  check(iteration >= 0 && !(change < 0), "progress");
  ++*(int*)user;
  return 1;
}

static void test_ends(void) {
  int calls = 0;
  slipstick_solution* solution = NULL;
  check(slipstick_solve(kScene, NULL, 0, NULL, 0, stop_at_once, &calls, &solution) == SLIPSTICK_STOPPED && calls == 1 &&
            solution == NULL,
        "the caller may stop a solve");
  solution = solved(SLIPSTICK_NOT_CONVERGED, 0, 1, &(const char*){"solver.max_iterations=1"});
  check(strlen(slipstick_message()) > 0, "it says why it did not converge");
  slipstick_solution_free(solution);
  check(slipstick_solve("[upper]\nshape = \"shpere\"\n", "mine.toml", 0, NULL, 0, NULL, NULL, &solution) ==
                SLIPSTICK_BAD_INPUT &&
            says("mine.toml:2") && solution == NULL,
        "a text's errors have its name and line");
  check(slipstick_solve(kScene, NULL, 0, NULL, 0, NULL, NULL, NULL) == SLIPSTICK_BAD_INPUT, "nowhere to put it");
  solution = solved(SLIPSTICK_OK, 1e-3, 1, &(const char*){"solver.model=auto"});
  check(number(solution, "accuracy.reached") <= 1e-3, "an accuracy is reached");
  check(strstr(slipstick_solution_text(solution), "target 0.001") != NULL, "the text names the requested accuracy");
  slipstick_solution_free(solution);
  solved(SLIPSTICK_BAD_INPUT, 2.0, 0, NULL);
}

/* A program that writes 1,5 reads the same profiles, where this machine has a language that does. */
static void test_locale(void) {
  static const char* const kCommas[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "es_ES.UTF-8", "it_IT.UTF-8", "nl_NL.UTF-8"};
  const double plain = one("power:1.5", SLIPSTICK_MOMENT_RATIO, 0.5, SLIPSTICK_TWIST);
  for (size_t i = 0; i < sizeof kCommas / sizeof *kCommas; ++i) {
    if (setlocale(LC_ALL, kCommas[i]) == NULL) continue;
    char text[8];
    snprintf(text, sizeof text, "%.1f", 1.5);
    check(strcmp(text, "1,5") == 0, "a locale with commas");
    check(one("power:1.5", SLIPSTICK_MOMENT_RATIO, 0.5, SLIPSTICK_TWIST) == plain, "numbers in a name are plain");
    snprintf(text, sizeof text, "%.1f", 1.5);
    check(strcmp(text, "1,5") == 0, "the caller's locale is as it was");
    setlocale(LC_ALL, "C");
    return;
  }
  puts("no locale with commas is installed: not tried");
}

int main(void) {
  check(strlen(slipstick_version()) >= 5, "a version");
  test_constants();
  test_states("hertz");
  test_states("rounded_punch:0.5");
  test_histories("flat_punch");
  test_stresses();
  test_refusals();
  test_solution();
  test_refusals_of_a_solution();
  test_ends();
  test_locale();
  if (failures == 0) puts("all holds");
  return failures == 0 ? 0 : 1;
}
