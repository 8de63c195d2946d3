#include "ricochet/base/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

/// @file JSON documents: written values are read back, and errors of format are reported.
namespace ricochet {
namespace {

TEST(JsonDocument, IsMadeOfBracedLists) {
  const Json json{{"name", "disc"}, {"sizes", {1, 2}}, {"empty", Json::array()}, {"pair", Json::array({"a", 1})}};
  EXPECT_EQ(json.dump(), R"({"name":"disc","sizes":[1,2],"empty":[],"pair":["a",1]})");
  EXPECT_EQ(Json(std::vector<double>{0.1, 2.0}).dump(), "[0.1,2.0]");
  EXPECT_EQ(Json(true).dump() + Json().dump() + Json(-3L).dump() + Json("x").dump(), "truenull-3\"x\"");
}

TEST(JsonDocument, IsReadAsItWasWritten) {
  const std::string text = R"({"b":[1,-2,0.1,1e-300,true,null,"ä\n"],"a":{"c":{}}})";
  const Json json = Json::parse(text);
  EXPECT_EQ(json.dump(), text) << "entries keep their order";
  EXPECT_EQ(Json::parse(json.dump(2)).dump(), text);
  EXPECT_EQ(json.at("b").at(std::size_t{2}).get<double>(), 0.1);
  EXPECT_TRUE(json.at("a").at("c").is_object());
}

TEST(JsonDocument, IsChangedInPlace) {
  Json json;
  json["list"] = Json::array();
  json["list"].push_back({{"x", 1}});
  json["list"][0UL]["x"] = 2;
  json.update({{"list2", Json::object()}, {"list", json.at("list")}});
  EXPECT_EQ(json.dump(), R"({"list":[{"x":2}],"list2":{}})");
}

TEST(JsonDocument, SaysInfinitiesInWords) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {1.5, infinite, -infinite}) EXPECT_EQ(Json::number(value).to_number(), value);
  EXPECT_TRUE(std::isnan(Json::number(NAN).to_number()));
  EXPECT_EQ(Json::number(infinite).dump(), "\"inf\"");
}

TEST(JsonDocument, ConvertsWhatFits) {
  const Json json = Json::parse(R"({"i":3,"d":2.5,"s":"t","l":["a","b"],"n":[1,2],"m":{"k":"v"},"big":3000000000})");
  const int whole = json.at("i");
  const double number = json.at("i");
  const std::string text = json.at("s");
  const std::vector<std::string> list = json.at("l");
  EXPECT_EQ(whole, 3);
  EXPECT_EQ(number, 3.0);
  EXPECT_EQ(text, "t");
  EXPECT_EQ(list, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(json.at("n").get<std::vector<long>>(), (std::vector<long>{1, 2}));
  EXPECT_EQ((json.at("m").get<std::map<std::string, std::string>>().at("k")), "v");
  EXPECT_EQ(json.value("none", 4), 4);
  EXPECT_EQ(json.value("s", "other"), "t");
  EXPECT_EQ(json.at("big").get<long>(), 3000000000L);
}

TEST(JsonDocument, RefusesWhatDoesNot) {
  const Json json = Json::parse(R"({"s":"t","big":3000000000,"d":1e300})");
  EXPECT_THROW((void)json.at("none"), Json::Exception);
  EXPECT_THROW((void)json.at("s").get<double>(), Json::Exception);
  EXPECT_THROW((void)json.at("s").get<bool>(), Json::Exception);
  EXPECT_THROW((void)json.at("big").get<int>(), Json::Exception);
  EXPECT_THROW((void)json.at("d").get<long>(), Json::Exception);
  EXPECT_THROW((void)Json(2.7).get<long>(), Json::Exception);
  EXPECT_EQ(Json::parse("18446744073709551615").get<double>(), 0x1p64);
  EXPECT_THROW((void)json.at(std::size_t{0}), Json::Exception);
  EXPECT_THROW((void)json.at("s").items(), Json::Exception);
  for (const char* text : {"", "{", "[1,]", "{\"a\" 1}", "nan", "\"\xff\""})
    EXPECT_THROW((void)Json::parse(text), Json::Exception) << text;
}

/// Paths of files may contain any bytes.
TEST(JsonDocument, WritesTextsThatAreNoUtf8) { EXPECT_EQ(Json(std::string("a\xff")).dump(), "\"a\xef\xbf\xbd\""); }

}  // namespace
}  // namespace ricochet
