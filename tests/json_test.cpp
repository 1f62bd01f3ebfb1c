// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch.hpp>
#include <string>

#include "ramify/core/error.h"
#include "ramify/core/json.h"
#include "ramify/core/random.h"

using namespace ramify;

namespace {

std::string complaint(const std::string& text) {
  try {
    JsonDocument(text, "f.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

const char* const kSample =
    "{\"format\": \"demo\", \"version\": 1,\n \"list\": [1, -2.5, [3e2, \"a\\u00e9\\n\"], {\"deep\": null}], \"yes\": true}";

// A random document, nested at most `depth` deep.
Json random_json(Rng& rng, int depth) {
  switch (rng.below(depth > 0 ? 7 : 5)) {
    case 0: return Json();
    case 1: return Json(rng.uniform() < 0.5);
    case 2: return Json(static_cast<std::int64_t>(rng.next()) * 1000003 - (std::int64_t{1} << 50));
    case 3: return Json(rng.normal() * std::pow(10.0, rng.uniform(-300, 300)));
    case 4: {
      std::string text;
      for (int i = rng.below(6); i > 0; --i) text += static_cast<char>(rng.below(128));
      return Json(text);
    }
    case 5: {
      Json::Array items;
      for (int i = rng.below(5); i > 0; --i) items.push_back(random_json(rng, depth - 1));
      return Json(items);
    }
    default: {
      Json::Object members;
      for (int i = rng.below(5); i > 0; --i) members.push_back({"k" + std::to_string(i), random_json(rng, depth - 1)});
      return Json(members);
    }
  }
}

bool same(const Json& a, const Json& b) {
  if (a.value.index() != b.value.index()) return false;
  if (const auto* items = std::get_if<Json::Array>(&a.value)) {
    const auto& others = std::get<Json::Array>(b.value);
    return std::equal(items->begin(), items->end(), others.begin(), others.end(), same);
  }
  if (const auto* members = std::get_if<Json::Object>(&a.value)) {
    const auto& others = std::get<Json::Object>(b.value);
    return std::equal(members->begin(), members->end(), others.begin(), others.end(),
                      [](const JsonMember& x, const JsonMember& y) { return x.key == y.key && same(x.value, y.value); });
  }
  if (const auto* number = std::get_if<double>(&a.value)) return *number == std::get<double>(b.value);
  if (const auto* text = std::get_if<std::string>(&a.value)) return *text == std::get<std::string>(b.value);
  if (const auto* whole = std::get_if<std::int64_t>(&a.value)) return *whole == std::get<std::int64_t>(b.value);
  if (const auto* flag = std::get_if<bool>(&a.value)) return *flag == std::get<bool>(b.value);
  return true;
}

}  // namespace

TEST_CASE("a json document gives its values") {
  const JsonDocument doc(kSample, "f.json");
  CHECK(doc.check_format("demo", 1) == 1);
  const auto& list = doc.array(doc.member(doc.root(), "list"), 4);
  CHECK(doc.integer(list[0]) == 1);
  CHECK(doc.number(list[1]) == -2.5);
  CHECK(doc.integer(doc.array(list[2])[0]) == 300);
  CHECK(doc.text(doc.array(list[2])[1]) == "a\xC3\xA9\n");
  CHECK(doc.boolean(doc.member(doc.root(), "yes")));
  CHECK(doc.find(doc.root(), "no") == nullptr);
}

TEST_CASE("a value of the wrong kind is named by its path") {
  const JsonDocument doc(kSample, "f.json");
  const auto& list = doc.array(doc.member(doc.root(), "list"));
  CHECK_THROWS_WITH(doc.number(doc.array(list[2])[1]), "f.json: $.list[2][1]: expected a number, found a text");
  CHECK_THROWS_WITH(doc.integer(list[1]), "f.json: $.list[1]: expected a whole number, found -2.5");
  CHECK_THROWS_WITH(doc.number(list[0], 2, 5), "f.json: $.list[0]: 1 is below 2");
  CHECK_THROWS_WITH(doc.array(*doc.find(list[3], "deep")), "f.json: $.list[3].deep: expected a list, found null");
  CHECK_THROWS_WITH(doc.member(list[3], "x"), "f.json: $.list[3]: the field \"x\" is missing");
  CHECK_THROWS_WITH(doc.check_format("other", 1), Catch::Contains("this is a \"demo\", not a \"other\""));
  const JsonDocument newer(R"({"format": "demo", "version": 3})", "f.json");
  CHECK_THROWS_WITH(newer.check_format("demo", 1), Catch::Contains("made by a newer ramify"));
}

TEST_CASE("malformed json is refused with line and column") {
  CHECK(complaint("{\n \"a\": [1,\n  nan]}").rfind("f.json:3:4: malformed JSON in $.a[1]", 0) == 0);
  CHECK(complaint("") == "f.json: empty file");
  for (const char* bad : {"[NaN]", "[Infinity]", "[1e400]", "[-1e400]", "[01]", "[1.]", "[.5]", "[+1]", "[0x1]", "{'a':1}", "[1,]",
                          "{\"a\":1,}", "[1] 2", "[\"\\ud800\"]", "[\"\xff\"]", "[\"\xc0\xaf\"]", "[\"a\nb\"]", "// c\n[1]",
                          "{\"a\":1,\"a\":2}", "{\"x\":{\"a\":1,\"b\":0,\"a\":1}}", "nul", "[tru]", "\"open"}) {
    INFO(bad);
    CHECK_THROWS_AS(JsonDocument(bad, "f"), InputError);
  }
  CHECK(complaint("{\"x\":{\"a\":1,\"a\":2}}") == "f.json: $.x.a: the key \"a\" appears twice");
  CHECK(complaint("[\"\x1b[31m\xff\"]").find('\x1b') == std::string::npos);
}

TEST_CASE("every proper prefix of a json text is refused") {
  const std::string text = kSample;
  for (std::size_t length = 0; length < text.size(); ++length) {
    CHECK_THROWS_AS(JsonDocument(text.substr(0, length), "f"), InputError);
  }
}

TEST_CASE("mutated json text is read or refused but nothing else") {
  Rng rng(21);
  int read = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = kSample;
    for (int k = 1 + rng.below(3); k > 0; --k) text[rng.below(static_cast<int>(text.size()))] = static_cast<char>(rng.next());
    try {
      const JsonDocument doc(text, "f");
      ++read;
      JsonDocument(json_text(doc.root()), "f");
    } catch (const Error&) {
    }
  }
  CHECK(read > 100);
}

TEST_CASE("depth and amount of json are limited") {
  CHECK_NOTHROW(JsonDocument(std::string(64, '[') + std::string(64, ']'), "f"));
  CHECK_THROWS_AS(JsonDocument(std::string(65, '[') + std::string(65, ']'), "f"), LimitError);
  CHECK_THROWS_AS(JsonDocument(std::string(1000000, '['), "f"), LimitError);
  JsonLimits few;
  few.values = 10;
  CHECK_THROWS_AS(JsonDocument("[1,2,3,4,5,6,7,8,9,10]", "f", few), LimitError);
  few.bytes = 5;
  CHECK_THROWS_AS(JsonDocument("[1,2,3]", "f", few), LimitError);
}

TEST_CASE("json survives the way through text") {
  Rng rng(4);
  for (int trial = 0; trial < 2000; ++trial) {
    const Json value = random_json(rng, 5);
    const std::string text = json_text(value);
    const JsonDocument doc(text, "f");
    INFO(text);
    // A double without a fraction is written as a whole number and comes back as one: compare the second time round.
    CHECK(json_text(doc.root()) == text);
    const JsonDocument again(json_text(doc.root()), "f");
    CHECK(same(doc.root(), again.root()));
  }
  CHECK(json_quoted("a\"\\\n\x01\xff") == "\"a\\\"\\\\\\n\\u0001\xEF\xBF\xBD\"");
  CHECK_THROWS_AS(json_text(Json(std::numeric_limits<double>::infinity())), std::invalid_argument);
}
