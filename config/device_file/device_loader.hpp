#pragma once
// Device types that are no drives: couplers, terminals, encoders, valve islands. One file fills what the bus needs to know of one, and names
// its channels. Not real-time.

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "axes/port/encoder_channel.hpp"
#include "config/reading/file_library.hpp"
#include "ecat/bus_config.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

/// A value of a device under a name, before a machine gives it a point.
struct DeviceChannel {
    std::string name;
    runtime::IoDirection direction = runtime::IoDirection::input;
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    std::string unit{};                          ///< of `line`; empty: the number itself
    PointLine line{};                            ///< from the number of the object to that unit
    std::vector<runtime::PointStatus> status{};  ///< what the device says of it
    std::string doc{};
};

struct LoadedDevice {
    std::string title, vendor;
    std::string source, checked;  ///< where its facts come from, and against what they were checked
    std::shared_ptr<const ecat::DeviceDescription> device;
    std::vector<ecat::StartupSdo> startup;
    std::vector<DeviceChannel> channels;
    std::vector<axes::EncoderChannel> encoders{};  ///< positions that may be axes
    std::vector<std::string> files{};              ///< path of what was read
};

/// All problems at once, each with file, line and column.
[[nodiscard]] std::variant<LoadedDevice, std::vector<Error>> load_device(const std::string& path);
/// The same of a text that is, or will be, the file at `path`.
[[nodiscard]] std::variant<LoadedDevice, std::vector<Error>> load_device_text(const std::string& path, std::string_view text);

/// A plain digital terminal without mailbox: channels in1.. and out1.. .
[[nodiscard]] LoadedDevice digital_terminal(std::uint8_t inputs, std::uint8_t outputs);

/// Device files by name: `device: el3102`.
class DeviceLibrary : public FileLibrary<LoadedDevice> {
public:
    explicit DeviceLibrary(std::vector<std::string> folders) : FileLibrary(std::move(folders), load_device) {}
};

/// The channel that a machine file means: by name, or by number among those of its direction, from 1. nullptr: there is none.
[[nodiscard]] const DeviceChannel* find_channel(const LoadedDevice& device, runtime::IoDirection direction,
                                                const std::string& name) noexcept;
/// An input that counts, as far as its channel says: nothing of a latch.
[[nodiscard]] axes::EncoderChannel encoder_of(const DeviceChannel& channel);
/// Their names, for messages.
[[nodiscard]] std::vector<std::string> channel_names(const LoadedDevice& device, runtime::IoDirection direction);

}  // namespace taktwerk::config
