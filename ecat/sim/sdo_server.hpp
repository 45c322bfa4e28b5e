#pragma once
// The SDO server: one request payload in, one response payload out. Expedited, normal and segmented transfers in both
// directions, of entries and, where the description says so, of whole objects. Source: ETG.1000.6 5.6.2, SV33-E manual 6.2.8.

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

class SdoServer {
public:
    SdoServer(const DeviceDescription& description, ObjectDictionary& dictionary, DeviceModel& model);

    /// Test: every transfer of this object is aborted with `code` until it is 0 again.
    void abort_object(std::uint16_t index, std::uint8_t sub, std::uint32_t code);
    /// Test: segments that are read all carry the toggle bit of the first.
    void never_toggle() noexcept { toggles_ = false; }
    /// Forgets a transfer in progress.
    void reset() noexcept;
    /// `request` and `out` without the mailbox header, `out` as long as the mailbox allows. Bytes written to `out`; 0: nothing to answer.
    [[nodiscard]] std::size_t serve(std::span<const std::byte> request, std::span<std::byte> out, EsmState state, Instant now) noexcept;

private:
    enum class Transfer : std::uint8_t { none, upload, download };

    std::size_t upload(const SdoMessage& request, std::span<std::byte> out) noexcept;
    std::size_t upload_segment(const SdoMessage& request, std::span<std::byte> out) noexcept;
    std::size_t download(const SdoMessage& request, bool size_given, std::span<std::byte> out, EsmState state, Instant now) noexcept;
    std::size_t download_segment(const SdoMessage& request, std::span<std::byte> out, EsmState state, Instant now) noexcept;
    std::size_t abort(std::span<std::byte> out, std::uint16_t index, std::uint8_t sub, std::uint32_t code) noexcept;
    /// Abort code of finding the entry; 0: it is there.
    [[nodiscard]] std::uint32_t locate(std::uint16_t index, std::uint8_t sub, Entry*& entry) noexcept;
    /// Abort code of writing `data`; 0: written.
    [[nodiscard]] std::uint32_t store(Entry& entry, std::span<const std::byte> data, EsmState state, Instant now) noexcept;
    [[nodiscard]] std::uint32_t store_value(Entry& entry, std::int64_t value, EsmState state, Instant now) noexcept;

    // Complete access (sdo_server_complete.cpp). Each returns an abort code; 0: done.
    [[nodiscard]] std::uint32_t refuse_complete(std::uint16_t index, std::uint8_t first) const noexcept;
    [[nodiscard]] std::uint32_t collect(std::uint16_t index, std::uint8_t first, std::span<const std::byte>& value) noexcept;
    /// All entries or none.
    [[nodiscard]] std::uint32_t store_complete(std::uint16_t index, std::uint8_t first, std::span<const std::byte> data, EsmState state,
                                               Instant now) noexcept;
    [[nodiscard]] std::uint32_t store_entries(std::span<const Entry> object, std::uint8_t first, std::span<const std::byte> data,
                                              EsmState state, Instant now) noexcept;
    [[nodiscard]] std::span<const std::byte> value_of(const Entry& entry) noexcept;

    static constexpr std::size_t largest_value = 4096;

    const DeviceDescription& description_;
    ObjectDictionary& dictionary_;
    DeviceModel& model_;
    struct Refused {
        std::uint16_t index;
        std::uint8_t sub;
        std::uint32_t code;
    };
    std::vector<Refused> refused_;
    Transfer transfer_ = Transfer::none;
    std::uint16_t index_ = 0;
    std::uint8_t sub_ = 0;
    bool toggle_ = false, toggles_ = true;
    bool complete_ = false;         // the download in progress
    std::vector<std::byte> value_;  // of a segmented transfer
    std::size_t done_ = 0, total_ = 0;
};

}  // namespace taktwerk::ecat::sim
