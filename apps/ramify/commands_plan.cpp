// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs that plan paths: dendrite, stylize, moss.
#include <algorithm>
#include <memory>

#include "commands.h"
#include "outputs.h"
#include "presets.h"
#include "ramify/image/image_io.h"
#include "ramify/recipe/moss.h"
#include "ramify/recipe/planning.h"
#include "ramify/recipe/planning_pictures.h"
#include "ramify/skeleton/skeleton_io.h"

namespace ramify::app {
namespace {

const std::vector<std::string> kSkeletons{".json", ".swc", ".svg", ".geojson"};
const std::vector<std::string> kPaintings{".svg", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp"};

bool kept(const SharedOptions& shared, const std::string& output) { return shared.no_clobber && file_exists(output); }

struct DendriteArguments {
  DendriteRequest request;
  FieldFlags flags;
  std::string output, preset;
};

Outcome grow_paths(DendriteArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  if (a.preset == "list") return {{}, {}, preset_list(dendrite_presets(), shared.json)};
  check_extension("output", a.output, kSkeletons);
  check_options(describe(a.request));
  a.request.limits = shared.load_limits();
  check_outputs(shared, {a.output}, input_files(a.request));
  if (kept(shared, a.output)) return {{}, {a.output}, ""};
  check_dendrite(a.request);
  if (a.request.aggregate.walkers > 0) {
    save_skeleton(grow_walkers(a.request, shared.seed, monitor), a.output);
    return {{a.output}, {}, ""};
  }
  const DendriteTarget target = load_dendrite(a.request, shared.seed, monitor.stage("load", 0.0, 0.1));
  if (!shared.debug_dir.empty()) {  // first, so that it shows what blocks the way when nothing can grow
    make_folder(shared.debug_dir);
    save_lattice_fields(shared.debug_dir, target.lattice, target.generators, a.request.grow.metric, monitor);
  }
  const Dendrite dendrite = grow_dendrite(target, a.request.grow, Rng(shared.seed).child("dendrite"), monitor.stage("grow", 0.1, 0.8));
  if (!shared.debug_dir.empty()) {
    std::vector<int> nodes;
    for (const int end : dendrite.structure.endpoints) nodes.push_back(dendrite.structure.forest.nodes[static_cast<std::size_t>(end)]);
    save_endpoints(shared.debug_dir, dendrite.lattice, nodes, a.request.lattice.pitch / dendrite.refine);
  }
  save_skeleton(dendrite_lines(a.request, target, dendrite, monitor.stage("lines", 0.8, 1.0)), a.output);
  return {{a.output}, {}, ""};
}

struct MossArguments {
  MossRequest request;
  FieldFlags flags;
  std::string output;
};

Outcome grow_over(MossArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  check_extension("output", a.output, kPaintings);
  a.request.limits = shared.load_limits();
  check_outputs(shared, {a.output}, {a.request.picture});
  if (kept(shared, a.output)) return {{}, {a.output}, ""};
  paint_moss(a.request, shared.seed, a.output, monitor);
  return {{a.output}, {}, ""};
}

struct StylizeArguments {
  StylizeRequest request;
  FieldFlags flags;
  std::string output, preset;
};

// Options that would be passed over in silence.
void check_use(const StylizeRequest& request) {
  if (!request.tree && request.picture.empty()) throw OptionError("tree", "", "only trees can do without a picture; name one, or add --tree");
  if (!request.tree && request.layers > 1) throw OptionError("layers", std::to_string(request.layers), "has no effect without --tree");
  if (!request.size.empty() && !request.picture.empty()) throw OptionError("size", request.size, "has no effect with a picture; use --scale");
  if (request.tree && !request.mask.empty()) throw OptionError("mask", request.mask, "has no effect on trees");
}

Outcome stylize_paths(StylizeArguments& a, const SharedOptions& shared, const Monitor& monitor) {
  if (a.preset == "list") return {{}, {}, preset_list(stylize_presets(), shared.json)};
  check_extension("output", a.output, kSkeletons);
  check_options(describe(a.request));
  a.request.limits = shared.load_limits();
  check_use(a.request);
  std::vector<std::string> outputs;
  for (int i = 0; i < a.request.layers; ++i) outputs.push_back(a.request.layers == 1 ? a.output : numbered(a.output, i));
  check_outputs(shared, outputs, input_files(a.request));
  if (std::all_of(outputs.begin(), outputs.end(), [&](const std::string& path) { return kept(shared, path); })) return {{}, outputs, ""};
  const StylizedPicture made = stylize_picture(a.request, shared.seed, monitor);
  if (!shared.debug_dir.empty()) {
    make_folder(shared.debug_dir);
    save_stylize_intermediates(shared.debug_dir, made, a.request.stylize.metric, monitor);
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) save_skeleton(made.layers[i], outputs[i]);
  return {outputs, {}, ""};
}

// What both verbs have in common on the command line.
template <class Arguments>
void finish(CLI::App& app, const std::shared_ptr<Arguments>& a, Chosen& chosen, const std::vector<Preset>& presets,
            Outcome (*work)(Arguments&, const SharedOptions&, const Monitor&)) {
  app.add_option("-o,--output", a->output, "Skeleton to write (.json .swc .svg .geojson)")->type_name("FILE");
  app.add_option("--preset", a->preset, "Settings that go well together; list shows them all")->type_name("NAME|list");
  a->flags.add(app, describe(a->request), "Planning");
  add_shared(app, chosen.shared);
  app.callback([&chosen, a, &app, &presets, work] {
    if (a->preset != "list") {
      if (a->output.empty()) throw CLI::RequiredError("--output");
      if (!a->preset.empty()) apply_preset(presets, a->preset, app, describe(a->request));
    }
    chosen.work = [&chosen, a, work](const Monitor& m) { return work(*a, chosen.shared, m); };
  });
}

}  // namespace

void add_dendrite(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<DendriteArguments>();
  CLI::App* app = root.add_subcommand("dendrite", "Grow a dendrite by least-cost paths: frost, lightning, letters, rocks");
  app->add_option("--mask", a->request.mask, "Picture: paths run where it is white")->type_name("IMAGE");
  app->add_option("--node-weights", a->request.node_weights, "Float picture with a weight for every node; not positive = forbidden")->type_name("TIFF");
  app->add_option("--roots", a->request.roots, "Where paths start: \"x,y x,y …\" in px; several compete")->type_name("POINTS");
  app->add_option("--generator", a->request.generator, "What paths start from: white in a picture, a skeleton's branches, a drawing's lines")->type_name("FILE");
  app->add_option("--endpoints", a->request.endpoints, "Where paths end: a table of x,y in px, or a picture with white dots")->type_name("CSV|IMAGE");
  finish(*app, a, chosen, dendrite_presets(), grow_paths);
  app->footer("Examples:\n  ramify dendrite --preset fractal --seed 3 -o frost.json\n"
              "  ramify dendrite --preset lightning --size 900x1200 --pitch 3 --refine 3 -o bolt.json\n"
              "  ramify dendrite --mask letters.png --count-endpoints 400 -o letters.json\n"
              "  ramify dendrite --text Hello --count-endpoints 600 -o hello.json\n"
              "  ramify dendrite --preset fractal --lines distance -o contours.svg\n"
              "  ramify dendrite --roots \"150,250 370,250\" --count-endpoints 300 -o rivals.svg");
}

void add_moss(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<MossArguments>();
  CLI::App* app = root.add_subcommand("moss", "Let moss grow over a picture: hairs in its colours, in each other's shadow");
  app->add_option("picture", a->request.picture, "Picture (.png .jpg .tif .exr .webp)")->required();
  app->add_option("-o,--output", a->output, "Drawing or picture to write (.svg .png .jpg .tif .exr .webp)")->required()->type_name("FILE");
  a->flags.add(*app, describe(a->request.options), "Moss");
  add_shared(*app, chosen.shared);
  app->footer("Examples:\n  ramify moss peppers.png -o mossy.png\n"
              "  ramify moss photo.jpg --height 30 --hairs 0.6 --scale 2 -o fur.png");
  app->callback([&chosen, a] { chosen.work = [&chosen, a](const Monitor& m) { return grow_over(*a, chosen.shared, m); }; });
}

void add_stylize(CLI::App& root, Chosen& chosen) {
  const auto a = std::make_shared<StylizeArguments>();
  CLI::App* app = root.add_subcommand("stylize", "Tell a picture by the lines of one dendrite");
  app->add_option("picture", a->request.picture, "Picture (.png .jpg .tif .exr .webp); trees can do without");
  app->add_option("--mask", a->request.mask, "Picture of the same size: lines run where it is white")->type_name("IMAGE");
  app->add_option("--root", a->request.root, "Where the dendrite starts: \"x,y\" in px [on a main line near the middle, with --upward near the top; trees: the middle of the bottom]")->type_name("POINT");
  finish(*app, a, chosen, stylize_presets(), stylize_paths);
  app->footer("Examples:\n  ramify stylize portrait.jpg -o portrait.json && ramify paint portrait.json -o portrait.svg\n"
              "  ramify stylize cat.png --preset dense --scale 2 -o cat.json\n"
              "  ramify stylize --preset tree --seed 4 -o tree.json\n"
              "  ramify stylize portrait.jpg --preset hidden --layers 2 -o hidden.json");
}

}  // namespace ramify::app
