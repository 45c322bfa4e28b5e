// List objects: by complete access where that works, else entry by entry.
#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/coe/sdo_client.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t count_size = 2;  ///< sub-index 0 with complete access
constexpr std::size_t most_entries = 254;

/// The entries in the bytes of a complete transfer; nothing when count and size do not fit each other.
std::optional<std::vector<Bytes>> split(std::span<const std::byte> bytes, std::size_t entry_size) {
    if (bytes.size() < count_size) return std::nullopt;
    const std::size_t count = static_cast<std::size_t>(bytes[0]);
    if (bytes.size() != count_size + count * entry_size) return std::nullopt;
    std::vector<Bytes> entries;
    for (std::size_t n = 0; n < count; ++n) {
        const auto entry = bytes.subspan(count_size + n * entry_size, entry_size);
        entries.emplace_back(entry.begin(), entry.end());
    }
    return entries;
}

/// Whether entry by entry is worth a try after this; a slave that does not answer at all will not answer more questions.
bool answered(const Error& error) { return error.code == "sdo.abort" || error.code == "sdo.protocol"; }

}  // namespace

Script<Result<std::vector<std::vector<std::byte>>>> sdo_upload_list(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index,
                                                                    std::size_t entry_size) {
    if (mailbox.complete_access) {
        const Result<Bytes> all = co_await sdo_upload(port, mailbox, index, 0, SdoAccess::complete);
        if (!all && !answered(all.error())) co_return all.error();
        if (all)
            if (auto entries = split(*all, entry_size)) co_return std::move(*entries);
        mailbox.complete_access = false;
    }
    const Result<Bytes> count = co_await sdo_upload(port, mailbox, index, 0);
    if (!count) co_return count.error();
    const std::size_t entries_there = count->empty() ? 0 : static_cast<std::size_t>((*count)[0]);
    std::vector<Bytes> entries;
    for (std::size_t n = 1; n <= std::min(entries_there, most_entries); ++n) {
        Result<Bytes> entry = co_await sdo_upload(port, mailbox, index, static_cast<std::uint8_t>(n));
        if (!entry) co_return entry.error();
        entries.push_back(std::move(*entry));
    }
    co_return entries;
}

Script<Result<void>> sdo_download_list(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index,
                                       std::vector<std::vector<std::byte>> entries) {
    const auto count = static_cast<std::byte>(std::min(entries.size(), most_entries));
    if (mailbox.complete_access) {
        Bytes all(count_size);
        all[0] = count;
        for (const auto& entry : entries) all.insert(all.end(), entry.begin(), entry.end());
        const Result<void> written = co_await sdo_download(port, mailbox, index, 0, std::move(all), SdoAccess::complete);
        if (!written && !answered(written.error())) co_return written;
        if (written) {
            const Result<Bytes> back = co_await sdo_upload(port, mailbox, index, 0);
            if (back && !back->empty() && (*back)[0] == count) co_return Result<void>{};
        }
        mailbox.complete_access = false;
    }
    Bytes zero(1);
    Result<void> written = co_await sdo_download(port, mailbox, index, 0, std::move(zero));
    if (!written) co_return written;
    std::uint8_t sub = 0;
    for (auto& entry : entries) {
        written = co_await sdo_download(port, mailbox, index, ++sub, std::move(entry));
        if (!written) co_return written;
    }
    Bytes number(1, count);
    co_return co_await sdo_download(port, mailbox, index, 0, std::move(number));
}

}  // namespace taktwerk::ecat
