// SPDX-License-Identifier: GPL-3.0-or-later
// Histograms of input and output on top of each other (paper 002, figures 1 and 7), as SVG.
#pragma once

#include <string>
#include <vector>

#include "ramify/report/structure_figures.h"

namespace ramify {

// An <svg> element, several plots side by side. The exemplar is filled, the result a line.
std::string histogram_plots(const std::vector<HistogramFigure>& figures, const std::string& exemplar_name,
                            const std::string& result_name);

// Text made safe inside XML; control characters and broken UTF-8 are made visible.
std::string xml_text(const std::string& text);

// Four significant digits, whole from 1000 on; "-" for what is not finite.
std::string figure_text(double value);

}  // namespace ramify
