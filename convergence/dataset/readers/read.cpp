// Tests a law against torsion.csv: Tresca's twist of the stick ratio c is arcosh(1/c)/(2 pi).
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

int main() {
  std::ifstream file("../tables/torsion.csv");
  double stick = 0, lacks = 0, largest = 0;
  int tested = 0;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> row;  // case, given, at, radius, quantity, value, error, ...
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) row.push_back(word);
    if (row[0] != "constant") continue;
    const double value = std::stod(row[5]);
    if (row[4] == "stick_ratio") stick = value;
    if (row[4] == "stick_complement") lacks = value;
    if (row[4] != "twist") continue;  // of a load it follows both
    const double yours = std::asinh(std::sqrt(lacks * (1 + stick)) / stick) / (2 * std::acos(-1.0));
    largest = std::fmax(largest, std::fabs(yours / value - 1));
    ++tested;
  }
  std::printf("%d twists, largest relative error %.1e, allowed 1e-12\n", tested, largest);
  return !(tested > 0 && largest <= 1e-12);
}
