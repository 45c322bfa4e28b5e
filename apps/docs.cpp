// taktwerk docs PAGE: reference pages, generated from what the runtime uses. docs/reference/ and docs/configuration.md hold
// them as committed.

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "apps/exit_code.hpp"
#include "apps/reference_pages.hpp"
#include "apps/taktwerk.hpp"
#include "config/reference.hpp"
#include "fb_library/block_reference.hpp"

namespace taktwerk::apps {
namespace {

struct Page {
    const char* name;
    std::string (*text)();
};
constexpr std::array<Page, 5> pages{{
    {"blocks", fb::block_reference_markdown},
    {"configuration", config::reference_page},
    {"alarms", alarm_reference_markdown},
    {"errors", error_reference_markdown},
    {"parameters", parameter_reference_markdown},
}};

int write_page(const std::string& name, const std::string& output) {
    for (const auto& page : pages) {
        if (name != page.name) continue;
        auto* file = output.empty() ? stdout : std::fopen(output.c_str(), "w");
        if (!file) {
            print_error({"docs.output", output, fmt::format("the page cannot be written: {}", std::strerror(errno)),
                         "Choose another place with -o."});
            return exit_bad_file;
        }
        const auto text = page.text();
        std::fwrite(text.data(), 1, text.size(), file);
        if (!output.empty()) std::fclose(file);
    }
    return exit_ok;
}

}  // namespace

void add_docs(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("docs", "print a reference page as Markdown");
    struct Options {
        std::string page, output;
    };
    auto options = std::make_shared<Options>();
    std::vector<std::string> names;
    for (const auto& page : pages) names.emplace_back(page.name);
    sub->add_option("PAGE", options->page, "which page")->required()->check(CLI::IsMember(names));
    sub->add_option("-o,--output", options->output, "file; default: standard output");
    sub->callback([&action, options] { action = [options] { return write_page(options->page, options->output); }; });
}

}  // namespace taktwerk::apps
