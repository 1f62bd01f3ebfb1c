// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/core/monitor.h"
#include "ramify/core/options.h"
#include "ramify/core/ordered_tasks.h"
#include "ramify/core/parallel.h"
#include "ramify/core/random.h"
#include "ramify/core/rounding.h"
#include "ramify/core/types.h"
#include "support/temp_folder.h"

using namespace ramify;

TEST_CASE("philox gives the published known answers") {
  // Random123's kat_vectors for philox4x32-10.
  CHECK(philox4x32({0, 0, 0, 0}, {0, 0}) == std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("draws have the moments of their distributions") {
  Rng rng = Rng(7).child("test");
  const int n = 200000;
  double mean = 0, square = 0, normal_mean = 0, normal_square = 0;
  std::array<int, 5> counts{};
  const std::vector<double> weights{1.0, 0.0, 3.0, -2.0, std::nan("")};
  std::array<int, 5> drawn{};
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform(), z = rng.normal();
    mean += u, square += u * u, normal_mean += z, normal_square += z * z;
    ++counts[rng.below(5)];
    ++drawn[rng.discrete(weights)];
  }
  CHECK(mean / n == Approx(0.5).margin(0.003));
  CHECK(square / n == Approx(1.0 / 3.0).margin(0.003));
  CHECK(normal_mean / n == Approx(0.0).margin(0.01));
  CHECK(normal_square / n == Approx(1.0).margin(0.02));
  for (const int c : counts) CHECK(c == Approx(n / 5).epsilon(0.03));
  CHECK(drawn[0] == Approx(n / 4).epsilon(0.03));
  CHECK(drawn[1] + drawn[3] + drawn[4] == 0);
}

TEST_CASE("child streams differ from each other and do not depend on what was drawn") {
  Rng a(1), b(1);
  b.next();
  CHECK(a.child("x", 3).next() == b.child("x", 3).next());
  std::set<std::uint32_t> first;
  for (int i = 0; i < 1000; ++i) first.insert(a.child("x", i).next());
  CHECK(first.size() == 1000);
  CHECK(a.child("x").next() != a.child("y").next());
  CHECK(Rng(1).next() != Rng(2).next());
}

TEST_CASE("wrap_angle stays within half a turn and keeps the direction") {
  for (double a = -20.0; a < 20.0; a += 0.37) {
    const double w = wrap_angle(a);
    CHECK(w > -kPi);
    CHECK(w <= kPi);
    CHECK(std::cos(w) == Approx(std::cos(a)).margin(1e-9));
    CHECK(std::sin(w) == Approx(std::sin(a)).margin(1e-9));
  }
  CHECK(wrap_angle(-kPi) == Approx(kPi));
}

TEST_CASE("parallel_for runs every index once and reports the lowest failure") {
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    std::vector<int> hits(1000, 0);
    parallel_for(1000, [&](int i) { ++hits[i]; }, 7);
    CHECK(std::count(hits.begin(), hits.end(), 1) == 1000);
    std::vector<int> nested(64, 0);
    parallel_for(8, [&](int i) { parallel_for(8, [&](int j) { ++nested[i * 8 + j]; }); });
    CHECK(std::count(nested.begin(), nested.end(), 1) == 64);
    CHECK_THROWS_AS(parallel_for(100, [&](int i) { if (i == 40) throw InputError("f", "bad"); }), InputError);
  }
  set_thread_count(0);
}

TEST_CASE("a monitor reports progress that never falls, books time and stops") {
  std::vector<double> seen;
  const Monitor monitor([&](double f, const std::string&) { seen.push_back(f); });
  {
    const Monitor grow = monitor.stage("grow", 0.0, 0.5);
    grow.report(0.0);
    const Monitor inner = grow.stage("inner", 0.5, 1.0);
    inner.report(0.0);
  }
  const Monitor render = monitor.stage("render", 0.5, 1.0);
  CHECK(std::is_sorted(seen.begin(), seen.end()));
  CHECK(seen.back() == Approx(0.5));
  const auto times = monitor.timings();
  REQUIRE(times.size() == 2);
  CHECK(times[0].name == "grow/inner");
  CHECK(times[1].name == "grow");
  monitor.cancel();
  CHECK_THROWS_AS(render.report(0.5), Cancelled);
}

namespace {
enum class Taste { Sweet, Sour };
struct SampleOptions {
  int count = 3;
  double size = 2.5;
  bool loud = false;
  Taste taste = Taste::Sweet;
};
std::vector<OptionField> describe(SampleOptions& o) {
  return {number("count", o.count, 1, 9, "", "How many."), number("size", o.size, 0.0, 10.0, "px", "How large."),
          flag("loud", o.loud, "Shout."), choice("taste", o.taste, {"sweet", "sour"}, "Which.")};
}
}  // namespace

TEST_CASE("loops under a scope stop at a cancel and others do not") {
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    const Monitor monitor([](double, const std::string&) {});
    std::atomic<int> done{0};
    const auto body = [&](int i) {
      parallel_for(10, [&](int k) {  // a loop inside a loop listens too
        ++done;
        if (i == 5 && k == 5) monitor.cancel();
      });
    };
    {
      const CancelScope scope(monitor);
      const CancelScope inner(monitor);
      CHECK_THROWS_AS(parallel_for(1000, body), Cancelled);
      CHECK_THROWS_AS(check_cancel(), Cancelled);
    }
    CHECK(done >= 6 + 10 * (threads == 1 ? 5 : 0));
    CHECK(done < 10 * 20);
    CHECK_NOTHROW(check_cancel());  // the scope is over
    CHECK_NOTHROW(parallel_for(3, body));
  }
  set_thread_count(0);
}

TEST_CASE("a monitor knows its longest silence") {
  const Monitor monitor([](double, const std::string&) {});
  {
    const Monitor part = monitor.stage("part");
    part.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    part.check();
    part.check();
  }
  REQUIRE(monitor.timings().size() == 1);
  CHECK(monitor.timings()[0].longest_silence >= 0.03);
  CHECK(monitor.timings()[0].longest_silence <= monitor.timings()[0].seconds);
}

TEST_CASE("options read and write themselves and name what is wrong") {
  SampleOptions options;
  auto fields = describe(options);
  for (auto& field : fields) set_text(field, get_text(field));
  CHECK(options.count == 3);
  CHECK(options.size == 2.5);
  set_text(fields[3], "sour");
  CHECK(options.taste == Taste::Sour);
  CHECK_THROWS_AS(set_text(fields[3], "bitter"), OptionError);
  for (const char* bad : {"", "0", "10", "1.5", "1e3", "nan", "inf", "0x2", "3 ", "9223372036854775808"}) {
    CHECK_THROWS_AS(set_text(fields[0], bad), OptionError);
  }
  options.size = std::nan("");
  CHECK_THROWS_AS(check_options(fields), OptionError);
  try {
    set_text(fields[1], "11");
    FAIL("11 is out of range");
  } catch (const OptionError& error) {
    CHECK(std::string(error.what()) == "--size '11': expected from 0 to 10 px");
  }
}

TEST_CASE("numbers survive the way through text") {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = (rng.uniform() - 0.5) * std::pow(10.0, rng.uniform(-200, 200));
    double y = 0;
    REQUIRE(parse_number(number_text(x), y));
    CHECK(x == y);
  }
}

TEST_CASE("atomic files appear whole or not at all") {
  const TempFolder folder;
  const std::string path = folder / "a.txt";
  write_file(path, "old");
  {
    AtomicFile file(path);
    file.write("half of the new");
    CHECK(read_file(path, 100) == "old");
  }
  CHECK(read_file(path, 100) == "old");
  write_file(path, "new");
  CHECK(read_file(path, 100) == "new");
  CHECK(folder.entries() == std::vector<std::string>{"a.txt"});
  CHECK_THROWS_AS(AtomicFile(folder.path()), OutputError);
  CHECK_THROWS_AS(AtomicFile(folder / "missing/a.txt"), OutputError);
  std::filesystem::create_symlink(path, folder / "link");
  CHECK_THROWS_AS(AtomicFile(folder / "link"), OutputError);
  CHECK_THROWS_AS(AtomicFile(folder / std::string(300, 'x')), OutputError);
  {
    AtomicFile file(folder / "b.txt");
    remove_unfinished_files();
    CHECK(folder.entries() == std::vector<std::string>{"a.txt", "link"});
  }
}

TEST_CASE("a full disk is an OutputError and leaves nothing") {
  // Files larger than RLIMIT_FSIZE fail like a full disk does; /dev/full is refused as a device before that.
  CHECK_THROWS_AS(AtomicFile("/dev/full"), OutputError);
}

TEST_CASE("read_file refuses what is not a file") {
  const TempFolder folder;
  CHECK_THROWS_AS(read_file(folder / "none", 10), InputError);
  CHECK_THROWS_AS(read_file(folder.path(), 10), InputError);
  CHECK_THROWS_AS(read_file("/dev/zero", 10), InputError);
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_THROWS_AS(read_file(folder / "pipe", 10), InputError);
  write_file(folder / "big", "01234567890");
  CHECK_THROWS_AS(read_file(folder / "big", 10), LimitError);
}

TEST_CASE("printable text cannot drive a terminal") {
  CHECK(printable("plain é…") == "plain é…");
  CHECK(printable("\x1b[31mred\n") == "\\x1b[31mred\\x0a");
  CHECK(printable("\xc0\xaf\xed\xa0\x80\xff") == "\\xc0\\xaf\\xed\\xa0\\x80\\xff");
  CHECK(printable("\xc2\x9b" "2J") == "\\xc2\\x9b2J");
  CHECK(printable(std::string(500, 'a')).size() < 210);
}

TEST_CASE("rounding to a whole number is lround's") {
  Rng rng(31);
  const auto check = [](double v) { CHECK(round_to_int(v) == static_cast<int>(std::lround(v))); };
  for (const double v : {0.0, -0.0, 0.5, -0.5, 1.5, 2.5, -2.5, 0.49999999999999994, -0.49999999999999994, 1e9 + 0.5, -1e9 - 0.5}) check(v);
  for (int i = 0; i < 20000; ++i) {
    const double v = rng.uniform(-5000.0, 5000.0), half = std::floor(v) + 0.5;
    for (const double w : {v, half, std::nextafter(half, 1e9), std::nextafter(half, -1e9)}) check(w);
  }
}

TEST_CASE("tasks wait for those before them and each runs once with any number of threads") {
  Rng rng(41);
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    for (int trial = 0; trial < 20; ++trial) {
      const int count = rng.below(200);
      std::vector<std::vector<int>> after(static_cast<std::size_t>(count));
      for (int i = 1; i < count; ++i) {
        for (int k = rng.below(4); k > 0; --k) after[i].push_back(rng.below(i));
      }
      std::vector<std::atomic<int>> ended(static_cast<std::size_t>(count));
      std::atomic<int> early = 0;
      run_in_order(after, [&](int i) {
        for (const int j : after[i]) early += ended[j] != 1;
        ++ended[i];
      });
      CHECK(early == 0);
      for (const auto& n : ended) CHECK(n == 1);
    }
    std::atomic<int> begun = 0;
    const std::vector<std::vector<int>> chain{{}, {0}, {1}, {2}};
    CHECK_THROWS_AS(run_in_order(chain,
                                 [&](int i) {
                                   if (++begun; i == 1) throw InputError("", "no");
                                 }),
                    InputError);
    CHECK(begun == 2);
  }
  set_thread_count(0);
}
