#include "convergence/results/result_parts.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace slipstick::convergence {
namespace {

using testing::ElementsAre;

TEST(Quantity, IsFoundByItsPath) {
  const Json result{{"a", {{"b.c", {{"d", 1}}}, {"b", {{"c", {{"d", 2}, {"e", 3}}}}}}},
                    {"list", {{{"x", 4}}, {{"x", {5, 6}}}}},
                    {"none", nullptr},
                    {"none_reason", "because"}};
  const auto at = [&](const std::string& path) {
    const FoundQuantity found = find_quantity(result, path);
    return found.value == nullptr ? -1 : found.value->get<int>();
  };
  EXPECT_EQ(at("a.b.c.d"), 1);
  EXPECT_EQ(at("a.b.c.e"), 3) << "the key with a dot leads nowhere, the other does";
  EXPECT_EQ(at("list[0].x"), 4);
  EXPECT_EQ(at("list[1].x[1]"), 6);
  for (const char* path :
       {"", "a.b.x", "lis", "list[2].x", "list[-1].x", "list[1", "list[].x", "list[1x].x", "list.x"}) {
    EXPECT_EQ(at(path), -1) << path;
  }
  EXPECT_EQ(find_quantity(result, "none.deeper").reason, "because");
  EXPECT_EQ(find_quantity(result, "a.b.c.e").reason, "");
  EXPECT_THAT(quantity_paths(result), ElementsAre("a.b.c.d", "a.b.c.d", "a.b.c.e", "list[0].x", "list[1].x[0]",
                                                  "list[1].x[1]", "none", "none_reason"));
}

}  // namespace
}  // namespace slipstick::convergence
