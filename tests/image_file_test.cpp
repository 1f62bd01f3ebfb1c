// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures meet the file system: odd names, things that are no files, full disks.
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>

#include "ramify/core/atomic_file.h"
#include "ramify/core/error.h"
#include "ramify/image/image_io.h"
#include "support/pictures.h"
#include "support/temp_folder.h"

using namespace ramify;

TEST_CASE("what is no regular file is refused at once") {
  const TempFolder folder;
  REQUIRE(mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "socket.png").c_str(), sizeof address.sun_path - 1);
  REQUIRE(bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  for (const std::string& path :
       {folder.path(), folder / "pipe.png", folder / "socket.png", folder / "missing.png", std::string("/dev/zero"),
        std::string(), folder / std::string(300, 'x'), folder / std::string(5000, 'y')}) {
    CHECK_THROWS_AS(load_image(path), InputError);
  }
  close(descriptor);
  write_file(folder / "big.png", std::string(1000, 'x'));
  CHECK_THROWS_AS(load_image(folder / "big.png", {.file_bytes = 999}), LimitError);
}

TEST_CASE("odd names work for reading and writing") {
  const TempFolder folder;
  const ColorImage image = level_noise(3, 2, 8);
  for (const std::string& name : {std::string("with space.png"), std::string("grün.png"), std::string("new\nline.png"),
                                  std::string("-x.png"), std::string("a;b'c\"d.png"), std::string(251, 'n') + ".png"}) {
    save_image(folder / name, image);
    CHECK(load_image(folder / name).color == image);
  }
  CHECK(folder.entries().size() == 6);
  CHECK_THROWS_AS(save_image(folder / (std::string(252, 'n') + ".png"), image), OutputError);
}

TEST_CASE("a jpeg brings its recipe in a file beside it") {
  const TempFolder folder;
  const ColorImage image = level_noise(8, 8, 8);
  save_image(folder / "a.jpg", image, {.recipe = "{}"});
  CHECK(folder.entries() == std::vector<std::string>{"a.jpg", "a.jpg.recipe.json"});
  CHECK(load_image(folder / "a.jpg").texts.at("ramify-recipe") == "{}");
  save_image(folder / "b.jpg", image);
  CHECK(load_image(folder / "b.jpg").texts.empty());
}

TEST_CASE("outputs replace files and never follow links") {
  const TempFolder folder;
  const ColorImage first = level_noise(3, 2, 8, 1), second = level_noise(3, 2, 8, 2);
  save_image(folder / "a.png", first);
  save_image(folder / "a.png", second);
  CHECK(load_image(folder / "a.png").color == second);
  REQUIRE(symlink((folder / "a.png").c_str(), (folder / "link.png").c_str()) == 0);
  CHECK_THROWS_AS(save_image(folder / "link.png", first), OutputError);
  REQUIRE(mkdir((folder / "folder.png").c_str(), 0700) == 0);
  CHECK_THROWS_AS(save_image(folder / "folder.png", first), OutputError);
  CHECK_THROWS_AS(save_image("/dev/full", first), OptionError);
  CHECK(load_image(folder / "a.png").color == second);
}

TEST_CASE("a write that fails is an output error and keeps the old picture") {
  const TempFolder folder;
  const ColorImage small = level_noise(3, 2, 8), large = level_noise(200, 200, 8);
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const char* name : {"a.png", "a.tif", "a.jpg", "a.exr", "a.webp"}) {
    SaveOptions options{.bits = fitting_bits(name, 8), .quality = 100, .recipe = "{}"};
    save_image(folder / name, small, options);
    const std::string old = read_file(folder / name, 1 << 20);
    const auto entries = folder.entries();
    rlimit tight{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &tight);  // a file grows to 4096 bytes and no further, like on a full disk
    bool failed = false;
    try {
      save_image(folder / name, large, options);
    } catch (const OutputError& error) {
      failed = error.code() == ExitCode::Output;
    }
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(failed);
    CHECK(read_file(folder / name, 1 << 20) == old);
    CHECK(folder.entries() == entries);
  }
  std::signal(SIGXFSZ, old_handler);
}
