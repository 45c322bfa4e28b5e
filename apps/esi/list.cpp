// taktwerk esi list FILE: which devices a vendor's file describes.

#include <cstdio>

#include <fmt/format.h>

#include "apps/esi/esi.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {

using ecat::esi::EsiFile;

std::string esi_list_text(const EsiFile& file, bool all, Colours colours) {
    const auto& devices = file.devices();
    TextTable table(
        {{"no.", TextTable::Column::Side::right}, {"type"}, {"product"}, {"revision"}, {"name", TextTable::Column::Side::left, 60}});
    std::size_t hidden = 0;
    for (std::size_t n = 0; n < devices.size(); ++n) {
        const auto& device = devices[n];
        if (device.hidden && !all) {
            ++hidden;
            continue;
        }
        const bool passive = device.identity.product == 0;
        const Tone tone = device.hidden || passive ? Tone::faint : Tone::plain;
        auto name = device.name.empty() ? device.chinese : device.name;
        if (!device.chinese.empty() && device.chinese != name) name += " · " + device.chinese;
        table.add({Cell{std::to_string(n + 1), tone}, Cell{device.type, device.hidden ? Tone::faint : Tone::strong},
                   Cell{passive ? "none" : fmt::format("{:08X}h", device.identity.product), tone},
                   Cell{passive ? "" : fmt::format("{:08X}h", device.identity.revision), tone}, Cell{name, tone}});
    }
    auto text = fmt::format("{}: {} (vendor {:08X}h), {}\n", toned(file.name(), Tone::strong, colours),
                            file.vendor_name().empty() ? "a vendor without a name" : file.vendor_name(), file.vendor(),
                            count_text(devices.size(), "device"));
    if (!table.empty()) text += "\n" + table.text(colours, 2);
    if (hidden > 0)
        text += "\n" +
                wrapped(fmt::format("{} older or hidden: --all shows them, --revision chooses one.", count_text(hidden, "revision")), 0) +
                "\n";
    return text;
}

EsiJson esi_list_json(const EsiFile& file) {
    EsiJson devices = EsiJson::array();
    for (const auto& device : file.devices())
        devices.push_back({{"type", device.type},
                           {"name", device.name},
                           {"name_chinese", device.chinese},
                           {"group", device.group},
                           {"product", device.identity.product},
                           {"revision", device.identity.revision},
                           {"hidden", device.hidden},
                           {"line", device.line}});
    EsiJson remarks = EsiJson::array();
    for (const auto& remark : file.remarks()) remarks.push_back(remark.text());
    return {{"file", file.name()},
            {"vendor", file.vendor()},
            {"vendor_name", file.vendor_name()},
            {"devices", std::move(devices)},
            {"remarks", std::move(remarks)}};
}

void add_esi_list(CLI::App& esi, Action& action) {
    auto* sub = esi.add_subcommand("list", "the devices of a file: type, identity, name");
    auto options = add_esi_file(*sub);
    sub->add_flag("--all", options->all, "also revisions that newer ones of the file replace, and what the vendor hides");
    sub->add_flag("--json", options->json, "the answer as one JSON object");
    sub->callback([&action, options] {
        action = [options] {
            return with_esi_file(*options, [&](const EsiFile& file) {
                if (options->json) fmt::print("{}\n", esi_list_json(file).dump(-1, ' ', false, EsiJson::error_handler_t::replace));
                else fmt::print("{}", esi_list_text(file, options->all, colours_of_output()));
                std::fflush(stdout);
                if (!options->json)
                    for (const auto& remark : file.remarks()) print_warning(remark);
                return static_cast<int>(exit_ok);
            });
        };
    });
}

}  // namespace taktwerk::apps
