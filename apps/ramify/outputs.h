// SPDX-License-Identifier: GPL-3.0-or-later
// Names of outputs: numbered for --count, checked against the inputs, skipped under --no-clobber.
#pragma once

#include <string>
#include <vector>

namespace ramify::app {

struct SharedOptions;

// "out.png" for picture 3 of several: "out_0003.png".
std::string numbered(const std::string& path, int index);

inline const std::vector<std::string> kPictureExtensions{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp"};

bool has_extension(const std::string& path, const std::vector<std::string>& allowed);

// Throws OptionError for a name whose extension is none of `allowed` (".png"), so that long work does not end in a typo.
void check_extension(const std::string& option, const std::string& path, const std::vector<std::string>& allowed);

// Throws OutputError when an output, or the file of --timings, is also an input or another output, is a folder or
// symbolic link, or its folder is missing or cannot be written to.
void check_outputs(const SharedOptions& shared, std::vector<std::string> outputs,
                   const std::vector<std::string>& inputs);

bool file_exists(const std::string& path);

// Throws OutputError when it cannot be made.
void make_folder(const std::string& path);

std::string folder_of(const std::string& path);
std::string extension_of(const std::string& path);  // ".png", lower case

}  // namespace ramify::app
