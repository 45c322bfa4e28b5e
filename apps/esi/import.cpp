// taktwerk esi import FILE --device D [-o NAME.yaml]: a device file of ours, and a list of all that it does not hold.

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "apps/esi/esi.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "config/device_file/device_file_text.hpp"
#include "config/esi_import/import_check.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;
using config::EsiImport;
using ecat::esi::EsiFile;

Result<void> write(const std::string& path, const std::string& text, bool replace) {
    std::error_code ignored;  // such a place cannot be written to either
    if (!replace && fs::exists(path, ignored))
        return Error{"esi.exists", path, "there is such a file already", "choose another name, or say --replace"};
    auto* file = std::fopen(path.c_str(), "w");
    if (file == nullptr)
        return Error{"esi.output", path, fmt::format("the file cannot be written: {}", std::strerror(errno)),
                     "choose another place with -o"};
    const bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) != 0 || !whole)
        return Error{"esi.output", path, fmt::format("the file could not be written to its end: {}", std::strerror(errno)),
                     "make room, and try again"};
    return {};
}

std::string heading_of(const EsiImport& import) {
    return fmt::format("{}: made of the vendor's ESI file by `taktwerk esi import`, which said what is not in here.", import.file.title);
}

int import_device(const EsiOptions& options, const EsiFile& file, const ecat::esi::EsiReading& reading) {
    const fs::path output = options.output;
    if (!output.empty() && output.extension() != ".yaml") {
        print_error({"esi.name", options.output, "machines look for a device in a file that ends with .yaml",
                     fmt::format("say -o {}", fs::path(output).replace_extension(".yaml").string())});
        return exit_usage;
    }
    const auto name = output.stem().string();
    const auto import = config::import_device(reading, file.vendor_name(), fs::path(options.file).filename().string(), name);
    if (!import) {
        print_error(import.error());
        return import.error().code == "esi.name" ? exit_usage : exit_bad_file;
    }
    const auto text = config::device_file_text(import->file, heading_of(*import));
    if (const auto problems = config::problems_of_device(import->file.name, text); !problems.empty()) {
        for (const auto& problem : problems) print_error(problem);
        print_error({"esi.unusable", import->file.name, "the device cannot be used as the vendor describes it; nothing was written", ""});
        return exit_bad_file;
    }
    if (options.output.empty()) {
        fmt::print("{}", text);
        std::fflush(stdout);
        fmt::print(stderr, "{}", esi_import_text(*import, {}, Colours::off));
        return exit_ok;
    }
    if (const auto written = write(options.output, text, options.replace); !written) {
        print_error(written.error());
        return exit_bad_file;
    }
    fmt::print("{}", esi_import_text(*import, options.output, colours_of_output()));
    return exit_ok;
}

}  // namespace

std::string esi_import_text(const EsiImport& import, const std::string& written_to, Colours colours) {
    const auto& file = import.file;
    std::string out = toned(file.title, Tone::strong, colours) + "\n";
    out += wrapped(fmt::format("{}, {}, {}, {}, {}", count_text(file.device.sync_managers.size(), "sync manager"),
                               count_text(file.rx.size() + file.tx.size(), "PDO"), count_text(file.channels.size(), "channel"),
                               count_text(file.objects.size(), "object"), count_text(file.startup.size(), "start-up value")),
                   0) +
           "\n";
    if (file.device.slots.count > 0)
        out += fmt::format("{}, {}\n", count_text(file.device.slots.count, "slot"),
                           count_text(file.device.slots.modules.size(), "kind of module"));
    if (!import.leftovers.empty()) out += "\n" + toned("In the vendor's file, and not in this one", Tone::strong, colours) + "\n";
    for (const auto& one : import.leftovers)
        out += "  " + wrapped(one.meaning.empty() ? one.what : fmt::format("{}: {}", one.what, one.meaning), 4) + "\n";
    if (!written_to.empty())
        out += "\n" +
               wrapped(fmt::format("{} is written. It belongs into the folder devices/ beside the machine's folder; a slave there is `- {{ "
                                   "name: ..., device: {} }}`.",
                                   written_to, file.name),
                       0) +
               "\n";
    return out;
}

void add_esi_import(CLI::App& esi, Action& action) {
    auto* sub = esi.add_subcommand("import", "makes a device file of one device, and lists what such a file cannot hold");
    auto options = add_esi_file(*sub);
    add_esi_device(*sub, *options);
    sub->add_option("-o,--output", options->output, "the file to write, such as devices/el3104.yaml; without it: to standard output")
        ->type_name("FILE");
    sub->add_flag("--replace", options->replace, "write over a file that is there");
    sub->callback([&action, options] {
        action = [options] {
            return with_esi_device(*options,
                                   [&](const EsiFile& file, const auto& reading) { return import_device(*options, file, reading); });
        };
    });
}

}  // namespace taktwerk::apps
