// taktwerk docs PAGE: reference pages, generated from what the runtime uses. docs/reference/, docs/configuration.md and docs/drives/
// hold them as committed.

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/docs/command_pages.hpp"
#include "apps/docs/device_page.hpp"
#include "apps/docs/drive_pages.hpp"
#include "apps/docs/reference_pages.hpp"
#include "apps/machine/load.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "config/drive_file/drive_library.hpp"
#include "config/reference/reference.hpp"
#include "fb_library/block_reference.hpp"
#include "programs/api/abi.hpp"

namespace taktwerk::apps {
namespace {

struct Page {
    const char* name;
    std::string (*text)();
};
std::string devices_page() { return device_reference_markdown(device_folders({})); }
constexpr std::array<Page, 6> pages{{
    {"blocks", fb::block_reference_markdown},
    {"configuration", config::reference_page},
    {"alarms", alarm_reference_markdown},
    {"devices", devices_page},
    {"errors", error_reference_markdown},
    {"parameters", parameter_reference_markdown},
}};

constexpr const char* drives_page = "drives";
constexpr const char* manual_pages = "man";
constexpr const char* completion = "completion";

/// To standard output when there is no file.
int write_text(const std::string& text, const std::string& output) {
    auto* file = output.empty() ? stdout : std::fopen(output.c_str(), "w");
    if (!file) {
        print_error(
            {"docs.output", output, fmt::format("the page cannot be written: {}", std::strerror(errno)), "Choose another place with -o."});
        return exit_bad_file;
    }
    std::fwrite(text.data(), 1, text.size(), file);
    if (!output.empty()) std::fclose(file);
    return exit_ok;
}

int write_drive(const config::LoadedDrive& drive, const std::string& folder) {
    if (folder.empty()) return write_text(fmt::format("## {}\n\n{}", drive.profile->title, drive_features_markdown(drive)), {});
    const auto written = drive_pages(drive, folder);
    if (!written) {
        print_error(written.error());
        return exit_bad_file;
    }
    for (const auto& page : *written)
        if (const int code = write_text(page.text, folder + "/" + page.file); code != exit_ok) return code;
    return exit_ok;
}

/// One drive, or all that are found when `name` is empty.
int write_drives(const std::string& name, const std::string& folder) {
    config::DriveLibrary library(drive_folders({}));
    const auto names = name.empty() ? library.names() : std::vector<std::string>{name};
    for (const auto& each : names) {
        const auto* drive = library.find(each);
        if (!drive) {
            if (!library.errors().empty()) print_errors(library.errors());
            else
                print_error(
                    {"docs.no_drive", each, "there is no such drive file", fmt::format("Known: {}.", fmt::join(library.names(), ", "))});
            return exit_bad_file;
        }
        if (name.empty() && !drive->profile->assumptions.empty()) continue;  // no manual, no page
        if (const int code = write_drive(*drive, folder); code != exit_ok) return code;
    }
    return exit_ok;
}

int write_page(const std::string& name, const std::string& output) {
    for (const auto& page : pages)
        if (name == page.name) return write_text(page.text(), output);
    return exit_ok;
}

int write_manual(const CLI::App& root, const std::string& folder) {
    const auto written = man_pages(root, sdk_version);
    if (folder.empty()) return write_text(written.front().second, {});
    for (const auto& [name, text] : written)
        if (const int code = write_text(text, folder + "/" + name); code != exit_ok) return code;
    return exit_ok;
}

}  // namespace

void add_docs(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("docs", "print a reference page as Markdown, the man pages, or the completion for bash");
    struct Options {
        std::string page, drive, output;
    };
    auto options = std::make_shared<Options>();
    std::vector<std::string> names;
    for (const auto& page : pages) names.emplace_back(page.name);
    for (const char* name : {drives_page, manual_pages, completion}) names.emplace_back(name);
    sub->add_option("PAGE", options->page, "which page")->required()->check(CLI::IsMember(names));
    sub->add_option("DRIVE", options->drive, "with `drives`: only this one");
    sub->add_option("-o,--output", options->output,
                    "file; default: standard output. With `drives` the folder of the documentation, with `man` one for all pages");
    sub->callback([&action, &app, options] {
        action = [&app, options] {
            if (options->page == manual_pages) return write_manual(app, options->output);
            if (options->page == completion) return write_text(bash_completion(app), options->output);
            return options->page == drives_page ? write_drives(options->drive, options->output)
                                                : write_page(options->page, options->output);
        };
    });
}

}  // namespace taktwerk::apps
