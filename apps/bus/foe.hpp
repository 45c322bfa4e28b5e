#pragma once
// `taktwerk bus file` and `taktwerk bus firmware`: what they share. Texts are pure, so that tests read them.

#include <cstddef>
#include <memory>
#include <string>

#include "apps/bus/bus.hpp"
#include "ecat/firmware/firmware_update.hpp"
#include "ecat/foe/file_transfer.hpp"

namespace taktwerk::apps {

struct FoeOptions {
    std::shared_ptr<BusOptions> bus;
    std::string slave, name, file, password;
    double patience_s = 0;  ///< for an answer; 0: the usual
};

/// --password, --timeout.
void add_foe_options(CLI::App& sub, FoeOptions& options);
/// Decimal, or hexadecimal after 0x. Error usage.number.
[[nodiscard]] Result<std::uint32_t> password_of(const std::string& text);

/// What a slave may be asked for: not empty, and nothing in it that no screen shows. Error foe.name, about `option`.
[[nodiscard]] Result<void> check_slave_file_name(const std::string& name, const char* option);

/// A line on standard error that says how far it is: on a terminal one that changes, elsewhere one each tenth. None with --json.
class FoeProgressLine {
public:
    explicit FoeProgressLine(const BusOptions& options);
    void show(const ecat::FoeProgress& progress);
    /// What was shown stays.
    void end();

private:
    bool silent_, terminal_;
    bool shown_ = false;
    int tenths_ = -1;
};
/// "4 of 12 KiB, 33 %, the slave is busy: 40 % 'flash'"
[[nodiscard]] std::string progress_text(const ecat::FoeProgress& progress);

/// As the options want them, with this line for the progress. The line outlives them.
[[nodiscard]] ecat::FoeSettings foe_settings(const FoeOptions& options, FoeProgressLine& line);
/// Its EEPROM says that it has no FoE: refused unless --force. Error foe.not_offered.
[[nodiscard]] Result<void> offers_files(const ecat::BusSlave& slave, const BusOptions& options);

// --- firmware.cpp ------------------------------------------------------------------------------------------------------------------
/// What failed, what the slave is left with, and the way back.
[[nodiscard]] Error firmware_error(const ecat::FirmwareOutcome& outcome);
[[nodiscard]] Json firmware_json(const std::string& subject, std::size_t bytes, const ecat::FirmwareOutcome& outcome);

}  // namespace taktwerk::apps
