// taktwerk bus init -o machines/NAME.yaml: a machine file to begin with, of what is on the bus.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/bus/machine_skeleton.hpp"
#include "apps/machine/load.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "config/device_file/device_file_text.hpp"
#include "config/drive_file/drive_library.hpp"
#include "config/esi_import/esi_import.hpp"
#include "config/esi_import/import_check.hpp"
#include "ecat/bringup/slave_match.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;
using ecat::esi::EsiFolder;
using Kind = RecognisedSlave::Kind;

struct InitOptions {
    std::shared_ptr<BusOptions> bus;
    std::string output, vendors;
};

Error not_written(const fs::path& path) {
    return {"init.output", path.string(), "the file cannot be written", "check the folder, and that you may write there"};
}

bool is_there(const fs::path& path) {
    std::error_code ignored;  // a place where nobody may look cannot be written to either
    return fs::exists(path, ignored);
}

Error there_already(const fs::path& path) {
    return {"init.exists", path.string(), "there is such a file already", "choose another name: nothing is written over"};
}

Result<void> write_new(const fs::path& path, const std::string& text) {
    if (is_there(path)) return there_already(path);
    std::error_code ignored;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), ignored);
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) return not_written(path);
    return {};
}

/// Drive and device files that a machine at `output` will find, and vendors' files beside them.
class Recognition {
public:
    Recognition(const std::string& output, const EsiFolder* vendors)
        : folder_((fs::path(output).parent_path() / ".." / "devices").lexically_normal()),
          drives_(drive_folders(output)),
          devices_(device_folders(output)),
          vendors_(vendors) {}

    RecognisedSlave recognise(const ecat::SurveyedSlave& slave) {
        if (slave.found.error) return {};
        const auto& id = slave.found.identity;
        if (auto drive = as_drive(id); drive.kind != Kind::unknown) return drive;
        if (auto device = as_device(id); device.kind != Kind::unknown) return device;
        return import(id);
    }
    [[nodiscard]] const std::vector<std::string>& written() const noexcept { return written_; }

private:
    RecognisedSlave as_drive(const ecat::Identity& id) {
        RecognisedSlave out;
        bool best_of_a_manual = false;
        for (const auto& name : drives_.names()) {
            const auto* drive = drives_.find(name);
            if (drive == nullptr || !drive->device || !ecat::recognises(*drive->device, id)) continue;
            const bool of_a_manual = drive->profile->assumptions.empty();
            if (out.kind == Kind::drive) {
                const bool better = of_a_manual && !best_of_a_manual;
                out.remark = fmt::format("it may be {} as well: both have this identity", better ? out.type : name);
                if (!better) continue;
            }
            best_of_a_manual = of_a_manual;
            out.kind = Kind::drive, out.type = name, out.axes = std::max<unsigned>(drive->profile->axes, 1);
        }
        return out;
    }

    /// Of several with this product the one of the same revision, else of the same variant, as EsiFolder chooses.
    RecognisedSlave as_device(const ecat::Identity& id) {
        RecognisedSlave out;
        constexpr std::uint32_t variant = 0xFFFF;
        std::tuple<bool, bool, std::uint32_t> best;
        for (const auto& name : devices_.names()) {
            const auto* device = devices_.find(name);
            if (device == nullptr || !ecat::check_identity("", *device->device, id)) continue;
            const auto revision = device->device->identity.revision;
            const std::tuple rank{revision == id.revision, (revision & variant) == (id.revision & variant), revision};
            if (out.kind == Kind::device && rank <= best) continue;
            best = rank;
            out.kind = Kind::device, out.type = name, out.device = device;
            out.remark = device->device->slots.count > 0 ? "modular: write `modules:` with what is in its slots" : "";
        }
        return out;
    }

    RecognisedSlave import(const ecat::Identity& id) {
        const auto* known = vendors_ != nullptr ? vendors_->find(id) : nullptr;
        if (known == nullptr) return {};
        RecognisedSlave out;
        const auto failed = [&](const Error& error) {
            out.remark = fmt::format("{} of {} could not be imported: {}", known->heading.type, known->file, error.what);
            return out;
        };
        const auto file = ecat::esi::EsiFile::open((fs::path(vendors_->path()) / known->file).string());
        if (!file) return failed(file.error());
        const auto& all = file->devices();
        const auto at = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.line == known->heading.line; });
        const auto made = config::import_device(file->read(static_cast<std::size_t>(at - all.begin())), known->vendor, known->file, {});
        if (!made) return failed(made.error());
        const auto& name = made->file.name;
        const auto text =
            config::device_file_text(made->file, made->file.title + ": made of the vendor's ESI file by `taktwerk bus init`.");
        if (const auto problems = config::problems_of_device(name, text); !problems.empty()) return failed(problems.front());
        const auto path = folder_ / (name + ".yaml");
        if (const auto done = write_new(path, text); !done) return failed(done.error());
        written_.push_back(path.string());
        out.kind = Kind::device, out.type = name, out.device = devices_.find(name);
        out.remark = fmt::format("{}: imported; `taktwerk esi import` lists what its file does not hold", made->file.title);
        return out;
    }

    fs::path folder_;
    config::DriveLibrary drives_;
    config::DeviceLibrary devices_;
    const EsiFolder* vendors_;
    std::vector<std::string> written_;
};

/// The bus as the file names it: as it was looked at here.
std::string interface_lines(const BusSession& session) {
    auto lines = fmt::format("  interface: {}\n", session.interface());
    if (const auto second = session.second_interface(); !second.empty()) lines += fmt::format("  ring: {{ interface2: {} }}\n", second);
    return lines;
}

int write_machine(const InitOptions& options, const BusSession& session, const ecat::Survey& survey, const EsiFolder* vendors) {
    Recognition recognition(options.output, vendors);
    std::vector<RecognisedSlave> slaves;
    std::size_t unknown = 0;
    for (const auto& slave : survey.slaves) {
        slaves.push_back(recognition.recognise(slave));
        if (slaves.back().kind == Kind::unknown) ++unknown;
    }
    if (unknown == slaves.size())
        return fail(*options.bus, Error{"init.nothing_known", "bus", "no file describes any of its slaves",
                                        "give the folder with the vendors' files: --esi DIR"});
    const auto name = config::device_file_name(fs::path(options.output).stem().string());
    if (const auto done = write_new(options.output, machine_skeleton(name, interface_lines(session), survey, slaves)); !done) {
        fail(*options.bus, done.error());
        return exit_bad_file;
    }
    for (const auto& file : recognition.written()) fmt::print("{} is written: imported from the vendor's file\n", file);
    fmt::print("{} is written: {}", options.output, count_text(slaves.size(), "slave"));
    if (unknown > 0) fmt::print(", {} of them unknown", unknown);
    fmt::print(". Next: fill in what is marked, then `taktwerk check {}`\n", options.output);
    return exit_ok;
}

}  // namespace

void add_bus_init(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("init", "writes a machine file to begin with, of what is on the bus");
    auto options = std::make_shared<InitOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_option("-o,--output", options->output, "the machine file to write, such as machines/cell.yaml")->required()->type_name("FILE");
    sub->add_option("--esi", options->vendors,
                    "a folder of vendors' ESI files: foreign slaves become device files in devices/ beside machines/")
        ->type_name("DIR");
    sub->callback([&action, options] {
        action = [options]() -> int {
            std::optional<EsiFolder> vendors;
            if (!options->vendors.empty()) {
                auto found = EsiFolder::open(options->vendors);
                if (!found) {
                    fail(*options->bus, found.error());
                    return exit_bad_file;
                }
                vendors = std::move(*found);
            }
            if (is_there(options->output)) {  // before anything is asked of the bus, or written beside it
                fail(*options->bus, there_already(options->output));
                return exit_bad_file;
            }
            return with_bus(*options->bus, [&](BusSession& session) {
                const auto survey = session.look();
                if (!survey) return fail(*options->bus, survey.error());
                return write_machine(*options, session, *survey, vendors ? &*vendors : nullptr);
            });
        };
    });
}

}  // namespace taktwerk::apps
