// taktwerk bundle diff: what is another in a newer version, so that somebody can say whether it may run.

#include <algorithm>

#include <fmt/format.h>

#include "apps/bundle/any_bundle.hpp"
#include "apps/bundle/commands.hpp"
#include "apps/bundle/yaml_difference.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {
namespace {

using namespace runtime;

struct DiffOptions {
    BundlePlaces places;
    std::string before, after;
};

const BundledFile* find(const Manifest& manifest, const std::string& path) {
    const auto found =
        std::find_if(manifest.files.begin(), manifest.files.end(), [&](const BundledFile& file) { return file.path == path; });
    return found == manifest.files.end() ? nullptr : &*found;
}

const BundledProgram* program_of(const Manifest& manifest, const std::string& path) {
    const auto found =
        std::find_if(manifest.programs.begin(), manifest.programs.end(), [&](const BundledProgram& one) { return one.path == path; });
    return found == manifest.programs.end() ? nullptr : &*found;
}

/// Of a changed file: what can be said of its inside.
Result<std::vector<std::string>> inside(const AnyBundle& before, const BundledFile& old, const AnyBundle& after, const BundledFile& now) {
    if (now.kind == "program") {
        const auto *was = program_of(before.manifest(), old.path), *is = program_of(after.manifest(), now.path);
        if (was == nullptr || is == nullptr) return std::vector<std::string>{};
        std::vector<std::string> lines{
            fmt::format("build {} -> {}", was->build_id.empty() ? "?" : was->build_id, is->build_id.empty() ? "?" : is->build_id)};
        if (was->abi != is->abi)
            lines.push_back(fmt::format("SDK {} (ABI {:016x}) -> {} (ABI {:016x})", was->sdk, was->abi, is->sdk, is->abi));
        return lines;
    }
    if (!now.path.ends_with(".yaml")) return std::vector<std::string>{fmt::format("{} -> {}", size_text(old.size), size_text(now.size))};
    const auto from = before.content(old);
    if (!from) return from.error();
    const auto to = after.content(now);
    if (!to) return to.error();
    auto lines = yaml_difference(*from, *to);
    if (lines.empty()) lines.emplace_back("comments or spaces only");
    return lines;
}

int diff(const DiffOptions& options) {
    const auto before = AnyBundle::find(options.before, options.places);
    if (!before) return fail_bundle(before.error());
    const auto after = AnyBundle::find(options.after, options.places);
    if (!after) return fail_bundle(after.error());
    const auto &old = before->manifest(), &now = after->manifest();
    fmt::print("{} {} ({}) -> {} {} ({})\n", old.name, old.version, utc_text(old.created), now.name, now.version, utc_text(now.created));
    if (old.target != now.target) fmt::print("target: {} -> {}\n", old.target, now.target);
    if (old.minimum_runtime != now.minimum_runtime) fmt::print("Taktwerk, at least: {} -> {}\n", old.minimum_runtime, now.minimum_runtime);
    std::size_t same = 0, other = 0;
    for (const auto& file : now.files) {
        const auto* was = find(old, file.path);
        if (was != nullptr && was->sha256 == file.sha256) {
            ++same;
            continue;
        }
        ++other;
        fmt::print("{} {}\n", was == nullptr ? "new    " : "changed", file.path);
        if (was == nullptr) continue;
        const auto lines = inside(*before, *was, *after, file);
        if (!lines) return fail_bundle(lines.error());
        for (const auto& line : *lines) fmt::print("          {}\n", line);
    }
    for (const auto& file : old.files)
        if (find(now, file.path) == nullptr) ++other, fmt::print("gone    {}\n", file.path);
    fmt::print("{}\n",
               other == 0 ? fmt::format("the same {}", count_text(same, "file")) : fmt::format("{} unchanged", count_text(same, "file")));
    return exit_ok;
}

}  // namespace

void add_bundle_diff(CLI::App& bundle, Action& action) {
    auto options = std::make_shared<DiffOptions>();
    auto* sub = bundle.add_subcommand("diff", "what is another in a newer version: files, and keys of YAML files");
    sub->add_option("BEFORE", options->before, "a file, cell@1.3.2, or cell: its active version")->required();
    sub->add_option("AFTER", options->after, "likewise")->required();
    add_root_option(*sub, options->places);
    sub->callback([&action, options] { action = [options] { return diff(*options); }; });
}

}  // namespace taktwerk::apps
