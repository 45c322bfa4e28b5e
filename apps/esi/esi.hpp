#pragma once
// The sub-commands of `taktwerk esi`, one file each. Their texts are made by pure functions, so that tests read them.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "apps/taktwerk.hpp"
#include "apps/terminal/text_table.hpp"
#include "config/esi_import/esi_import.hpp"
#include "ecat/esi/esi_file.hpp"

namespace taktwerk::apps {

using EsiJson = nlohmann::ordered_json;

struct EsiOptions {
    std::string file, device, revision, output;
    bool all = false, json = false, replace = false;
};

void add_esi_list(CLI::App& esi, Action& action);
void add_esi_show(CLI::App& esi, Action& action);
void add_esi_import(CLI::App& esi, Action& action);

/// FILE, and --device and --revision for what is about one device.
[[nodiscard]] std::shared_ptr<EsiOptions> add_esi_file(CLI::App& sub);
void add_esi_device(CLI::App& sub, EsiOptions& options);
/// One device of it, chosen by the words of --device and --revision (see choose_device()). Errors: its, and usage.number.
[[nodiscard]] Result<ecat::esi::EsiReading> read_esi_device(const ecat::esi::EsiFile& file, const std::string& device,
                                                            const std::string& revision);
/// What `work` comes to with the file, or the exit code of a file that cannot be read, which has been said.
[[nodiscard]] int with_esi_file(const EsiOptions& options, const std::function<int(const ecat::esi::EsiFile&)>& work);
/// The same with one device of it.
[[nodiscard]] int with_esi_device(const EsiOptions& options,
                                  const std::function<int(const ecat::esi::EsiFile&, const ecat::esi::EsiReading&)>& work);

[[nodiscard]] std::string esi_list_text(const ecat::esi::EsiFile& file, bool all, Colours colours);
[[nodiscard]] EsiJson esi_list_json(const ecat::esi::EsiFile& file);
[[nodiscard]] std::string esi_show_text(const std::string& vendor, const ecat::esi::EsiReading& reading, Colours colours);
[[nodiscard]] EsiJson esi_show_json(const std::string& vendor, const ecat::esi::EsiReading& reading);
/// What was taken, and everything that was not.
[[nodiscard]] std::string esi_import_text(const config::EsiImport& import, const std::string& written_to, Colours colours);

}  // namespace taktwerk::apps
