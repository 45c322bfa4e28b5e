#include "ecat/sim/slave_files.hpp"

#include <algorithm>
#include <utility>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat::sim {

namespace {

bool is_firmware(std::string_view name) { return name == "firmware" || name.starts_with("ECATFW__"); }

}  // namespace

SlaveFiles::SlaveFiles(const Identity& device, const FirmwareOptions& options)
    : flash_(device, options), firmware_password_(options.password) {
    incoming_.bytes.reserve(capacity);
}

SlaveFile* SlaveFiles::find(std::string_view name) noexcept {
    const auto found = std::find_if(files_.begin(), files_.end(), [&](const SlaveFile& file) { return file.name == name; });
    return found == files_.end() ? nullptr : &*found;
}

std::size_t SlaveFiles::used() const noexcept {
    std::size_t sum = 0;
    for (const auto& file : files_) sum += file.bytes.size();
    return sum;
}

std::uint32_t SlaveFiles::open_to_read(std::string_view name, std::uint32_t password, EsmState state) {
    abandon();
    if (is_firmware(name)) {
        if (firmware_password_ != 0 && password != firmware_password_) return foe_error::no_rights;
        content_ = flash_.image();
        return content_.empty() ? foe_error::not_found : 0;
    }
    if (state == EsmState::boot) return foe_error::not_bootstrap;
    const SlaveFile* file = find(name);
    if (file == nullptr) return foe_error::not_found;
    if (file->password != 0 && password != file->password) return foe_error::no_rights;
    content_ = file->bytes;
    return 0;
}

std::uint32_t SlaveFiles::open_to_write(std::string_view name, std::uint32_t password, EsmState state, Instant now) {
    abandon();
    if (is_firmware(name)) {
        if (state != EsmState::boot) return foe_error::bootstrap_only;
        if (firmware_password_ != 0 && password != firmware_password_) return foe_error::no_rights;
        firmware_open_ = true;
        flash_.begin(now);
        return 0;
    }
    if (state == EsmState::boot) return foe_error::not_bootstrap;
    if (name.empty() || name.size() > longest_name) return foe_error::illegal;
    const SlaveFile* file = find(name);
    if (file != nullptr && file->password != 0 && password != file->password) return foe_error::no_rights;
    if (file != nullptr && file->read_only) return foe_error::access_denied;
    incoming_.name = name;
    incoming_.password = file != nullptr ? file->password : 0;
    incoming_.bytes.clear();
    return 0;
}

std::uint32_t SlaveFiles::write(std::span<const std::byte> bytes, Instant now) {
    if (firmware_open_) return flash_.program(bytes, now);
    // Until it is complete the old one is there as well.
    if (bytes.size() > capacity - std::min(capacity, used() + incoming_.bytes.size())) return foe_error::disk_full;
    incoming_.bytes.insert(incoming_.bytes.end(), bytes.begin(), bytes.end());
    return 0;
}

std::uint32_t SlaveFiles::close() {
    if (std::exchange(firmware_open_, false)) return flash_.finish();
    if (SlaveFile* file = find(incoming_.name)) file->bytes = incoming_.bytes;
    else files_.push_back(incoming_);
    return 0;
}

void SlaveFiles::abandon() noexcept {
    firmware_open_ = false;
    content_ = {};
}

}  // namespace taktwerk::ecat::sim
