// taktwerk bundle show: what a bundle says of itself, and whether this computer would take it.

#include <fmt/format.h>

#include "apps/bundle/any_bundle.hpp"
#include "apps/bundle/commands.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/text_table.hpp"
#include "runtime/bundle/target.hpp"

namespace taktwerk::apps {
namespace {

using namespace runtime;

struct ShowOptions {
    BundlePlaces places;
    std::string bundle;
    bool json = false;
};

int show(const ShowOptions& options) {
    const auto bundle = AnyBundle::find(options.bundle, options.places);
    if (!bundle) return fail_bundle(bundle.error());
    if (options.json) {
        fmt::print("{}", bundle->manifest_text());
        return exit_ok;
    }
    const auto trust = options.places.trust();
    if (!trust) return fail_bundle(trust.error());
    const auto& manifest = bundle->manifest();
    fmt::print("machine '{}' {}, made at {}\n", manifest.name, manifest.version, utc_text(manifest.created));
    fmt::print("for {}, Taktwerk {} or later\n", manifest.target, manifest.minimum_runtime);
    fmt::print("{}\n", bundle->signature_words(*trust));
    const auto fit = fits(manifest, this_host(), options.bundle);
    fmt::print("{}\n", fit ? std::string("it fits this computer") : "it does not fit this computer: " + fit.error().what);
    for (const auto& program : manifest.programs)
        fmt::print("program {}: {}, SDK {} (interface {}, ABI {:016x}){}\n", program.name, program.path, program.sdk,
                   program.interface_version, program.abi, program.build_id.empty() ? "" : ", build " + program.build_id);
    TextTable table{{{"file"}, {"kind"}, {"bytes", TextTable::Column::Side::right}, {"SHA-256"}}};
    for (const auto& file : manifest.files) table.add({file.path, file.kind, std::to_string(file.size), {file.sha256, Tone::faint}});
    fmt::print("\n{}", table.text(colours_of_output()));
    return exit_ok;
}

}  // namespace

void add_bundle_show(CLI::App& bundle, Action& action) {
    auto options = std::make_shared<ShowOptions>();
    auto* sub = bundle.add_subcommand("show", "what is in a bundle, and whether this computer would take it");
    sub->add_option("BUNDLE", options->bundle, "a file, cell@1.4.0, or cell: its active version")->required();
    sub->add_flag("--json", options->json, "its manifest as it is");
    add_root_option(*sub, options->places);
    add_keys_option(*sub, options->places);
    sub->callback([&action, options] { action = [options] { return show(*options); }; });
}

}  // namespace taktwerk::apps
