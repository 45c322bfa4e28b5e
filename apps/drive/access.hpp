#pragma once
// The seam of `taktwerk drive`: one axis of one drive, however it is reached, and the choice of the way. Its sub-commands know nothing
// else. Ways: drive_in_machine.hpp (through the machine that runs), drive_over_bus.hpp (SDO on a bus that nobody else drives),
// drive_over_line.hpp (Modbus on a serial line). A further one implements DriveAccess and gets its line in with_drive().

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/bus/bus.hpp"
#include "axes/port/drive_profile.hpp"

namespace taktwerk::apps {

/// Where a write goes. A drive that stores every write is told not to, unless its user wants it: an EEPROM takes some 100,000 writes.
enum class Storing : std::uint8_t { volatile_only, asked };

struct DriveOptions {
    std::shared_ptr<BusOptions> bus;
    std::string socket;   ///< of the running machine that is asked: its path or the machine's name; empty: the only one
    std::string drive;    ///< position or name on the bus, or an axis of the running machine
    std::string profile;  ///< instead of the machine file's, or of what the identity says
    int axis = 1;         ///< of a drive with several
    Storing storing = Storing::volatile_only;
    // Of a serial line that no machine file describes; as an XP200 leaves the factory (9.2).
    std::string line;  ///< its port; empty: none
    std::uint32_t baud = 19200;
    std::string format = "8E1";

    /// A machine that runs is asked when it is named, or when neither bus nor line is.
    [[nodiscard]] bool through_machine() const noexcept {
        return !socket.empty() || (bus->nic.empty() && bus->machine.empty() && line.empty());
    }
};

/// The options that every sub-command has.
[[nodiscard]] std::shared_ptr<DriveOptions> add_drive_options(CLI::App& sub);
/// Also which drive and axis.
void add_drive_choice(CLI::App& sub, DriveOptions& options);
/// Also whether what is written is to outlive the power.
void add_store_option(CLI::App& sub, DriveOptions& options);

/// What a drive complains of, as numbers; drive.hpp has the words.
struct DriveComplaint {
    std::uint16_t code = 0;               ///< 603Fh or the vendor's number; 0: nothing
    std::optional<std::uint32_t> detail;  ///< of the further object that tells ambiguous codes apart
};

/// Not real-time; each call waits until it is done. Errors come as the drive, the bus or the machine says them.
class DriveAccess {
public:
    explicit DriveAccess(std::shared_ptr<const axes::DriveProfile> profile) : profile_(std::move(profile)) {}
    virtual ~DriveAccess() = default;
    DriveAccess(const DriveAccess&) = delete;
    DriveAccess& operator=(const DriveAccess&) = delete;

    [[nodiscard]] const axes::DriveProfile& profile() const noexcept { return *profile_; }
    /// "slave 0 'x_drive' (sv33-e)", with the axis where there are several.
    [[nodiscard]] virtual std::string subject() const = 0;
    /// How its user names it on the command line: "x_drive".
    [[nodiscard]] virtual std::string word() const = 0;
    /// "eth1", "simulated bus of 'demo'".
    [[nodiscard]] virtual std::string where() const = 0;

    [[nodiscard]] virtual Result<std::vector<std::byte>> read_bytes(const axes::DriveParameter& parameter) = 0;
    /// `storing` asked: its user wants it in the EEPROM, should the drive store writes; the caller sees to the drive's storage switch.
    [[nodiscard]] virtual Result<void> write_bytes(const axes::DriveParameter& parameter, std::vector<std::byte> value,
                                                   Storing storing) = 0;
    /// All parameters into the EEPROM at once, for drives that store on request. Error drive.cannot_store. Waits until the drive is done.
    [[nodiscard]] virtual Result<void> store_all() = 0;
    /// The way there refuses by itself what could move a motor by this parameter: nobody needs to be asked first.
    [[nodiscard]] virtual bool guards(const axes::DriveParameter&) const { return false; }
    [[nodiscard]] virtual Result<DriveComplaint> complaint() = 0;
    /// Asks the drive to forget its fault and ends when it has, or after `patience`. True: no fault any more.
    [[nodiscard]] virtual Result<bool> reset_fault(Duration patience) = 0;
    /// The encoder forgets its turns. Only through a running machine, which has to know that the axis lost its reference.
    [[nodiscard]] virtual Result<void> clear_turns();
    /// Lets time pass, so that a drive keeps up with what it stores.
    virtual void wait(Duration time) = 0;
    /// From now on Ctrl-C holds nothing back: what must be put back is put back.
    virtual void finish_undisturbed() = 0;

    [[nodiscard]] Result<std::int64_t> read(const axes::DriveParameter& parameter);
    [[nodiscard]] Result<void> write(const axes::DriveParameter& parameter, std::int64_t raw, Storing storing);

protected:
    [[nodiscard]] const std::shared_ptr<const axes::DriveProfile>& shared_profile() const noexcept { return profile_; }

private:
    std::shared_ptr<const axes::DriveProfile> profile_;
};

/// Finds the drive, its profile and the way to it, and returns what `work` does. Prints why it cannot.
int with_drive(const DriveOptions& options, const std::function<int(DriveAccess&)>& work);

}  // namespace taktwerk::apps
