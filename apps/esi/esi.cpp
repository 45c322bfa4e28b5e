// taktwerk esi: what vendors' XML files say of their slaves, and device files made of it.

#include "apps/esi/esi.hpp"

#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "ecat/esi/choose_device.hpp"
#include "ecat/esi/esi_number.hpp"

namespace taktwerk::apps {

Result<ecat::esi::EsiReading> read_esi_device(const ecat::esi::EsiFile& file, const std::string& device, const std::string& revision) {
    std::optional<std::uint32_t> number;
    if (!revision.empty()) {
        const auto read = ecat::esi::parse_number(revision);
        if (!read || *read < 0 || *read > ecat::esi::u32)
            return Error{"usage.number", "--revision", "'" + revision + "' is no revision",
                         "write it like 0x00140000, as `esi list` shows it"};
        number = static_cast<std::uint32_t>(*read);
    }
    const auto chosen = ecat::esi::choose_device(file, device, number);
    if (!chosen) return chosen.error();
    return file.read(*chosen);
}

std::shared_ptr<EsiOptions> add_esi_file(CLI::App& sub) {
    auto options = std::make_shared<EsiOptions>();
    sub.add_option("file", options->file, "the vendor's ESI file (XML)")->required()->type_name("FILE");
    return options;
}

void add_esi_device(CLI::App& sub, EsiOptions& options) {
    sub.add_option("--device", options.device,
                   "type of the device, such as EL3104, or its number in the list; needed where there are several")
        ->type_name("D");
    sub.add_option("--revision", options.revision, "another revision than the newest, such as 0x00140000")->type_name("R");
}

int with_esi_file(const EsiOptions& options, const std::function<int(const ecat::esi::EsiFile&)>& work) {
    const auto file = ecat::esi::EsiFile::open(options.file);
    if (file) return work(*file);
    print_error(file.error());
    return exit_bad_file;
}

int with_esi_device(const EsiOptions& options, const std::function<int(const ecat::esi::EsiFile&, const ecat::esi::EsiReading&)>& work) {
    return with_esi_file(options, [&](const ecat::esi::EsiFile& file) {
        const auto reading = read_esi_device(file, options.device, options.revision);
        if (reading) return work(file, *reading);
        print_error(reading.error());
        return static_cast<int>(exit_usage);
    });
}

void add_esi(CLI::App& app, Action& action) {
    auto* esi = app.add_subcommand("esi", "vendors' ESI files (XML): what is in them, and device files made of them");
    esi->require_subcommand(1);
    add_esi_list(*esi, action);
    add_esi_show(*esi, action);
    add_esi_import(*esi, action);
}

}  // namespace taktwerk::apps
