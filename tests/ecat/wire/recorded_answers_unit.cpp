// What real slaves answered to other masters, read by our decoders: not one message that they do not understand. Recorded
// traffic of devices that we have never seen is the nearest thing to hardware that a test can have.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "core/bytes.hpp"
#include "ecat/wire/al_status.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/registers.hpp"
#include "ecat/wire/sdo.hpp"
#include "ecat/wire/sdo_info.hpp"
#include "ecat/wire/sii.hpp"
#include "tests/ecat/wire/bytes_of.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

using test::copy_of;

/// Calls `visit` for each datagram that a slave has answered.
void for_each_answer(const std::filesystem::path& file, const std::function<void(const Datagram&)>& visit) {
    for (const auto& packet : test::read_pcapng(file)) {
        FrameReader reader{packet};
        while (const auto datagram = reader.next())
            if (datagram->working_counter() > 0) visit(*datagram);
    }
}

bool is_read(Command command) { return command == Command::FPRD || command == Command::APRD; }
bool is_write(Command command) { return command == Command::FPWR || command == Command::APWR; }

/// Where each slave's mailboxes are: as the recording's master wrote its sync managers 0 and 1.
class Mailboxes {
public:
    void learn(const Datagram& datagram) {
        if (!is_write(datagram.command)) return;
        for (unsigned n = 0; n < 2; ++n) {
            const std::size_t begin = reg::sync_manager_at(n), from = datagram.address.ado();
            if (begin < from || begin + SyncManager::size > from + datagram.data.size()) continue;
            const auto sm = decode_sync_manager(datagram.data.subspan(begin - from).first<SyncManager::size>());
            if (sm.is_mailbox() && sm.length > 0) known_[{datagram.address.adp(), sm.start}] = sm.is_written_by_master();
        }
    }
    [[nodiscard]] bool is_request(const Datagram& d) const { return is_write(d.command) && is(d, true); }
    [[nodiscard]] bool is_answer(const Datagram& d) const { return is_read(d.command) && is(d, false); }

private:
    [[nodiscard]] bool is(const Datagram& d, bool written_by_master) const {
        const auto it = known_.find({d.address.adp(), d.address.ado()});
        return it != known_.end() && it->second == written_by_master;
    }
    std::map<std::pair<std::uint16_t, std::uint16_t>, bool> known_;
};

struct Messages {
    std::size_t requests = 0, answers = 0, segments = 0, aborts = 0, infos = 0, emergencies = 0, others = 0;
};

void check_sdo(std::span<const std::byte> payload, Messages& seen) {
    const auto sdo = parse_sdo(payload);
    ASSERT_TRUE(sdo) << "an SDO that is not understood";
    switch (sdo->kind) {
        case SdoKind::abort:
            ++seen.aborts;
            EXPECT_NE(sdo_abort_text(sdo->abort_code), sdo_abort_text(0xDEADBEEF)) << std::hex << sdo->abort_code;
            break;
        case SdoKind::upload_segment_request:
        case SdoKind::upload_segment_response:
        case SdoKind::download_segment_request:
        case SdoKind::download_segment_response: ++seen.segments; break;
        default: EXPECT_NE(sdo->index, 0); break;
    }
}

/// What we would have written for the same request: the same bytes.
void check_upload_request(std::span<const std::byte> payload) {
    const auto sdo = parse_sdo(payload);
    if (!sdo || sdo->kind != SdoKind::upload_request) return;
    std::array<std::byte, sdo_initiate_size> ours{};
    ASSERT_EQ(encode_upload_request(ours, sdo->index, sdo->sub, sdo->complete_access), sdo_initiate_size);
    EXPECT_EQ(copy_of(ours), copy_of(payload.first(sdo_initiate_size)));
}

void check_info(std::span<const std::byte> payload, Messages& seen) {
    const auto info = parse_sdo_info(payload);
    ASSERT_TRUE(info) << "SDO information that is not understood";
    ++seen.infos;
    if (info->incomplete) return;  // the fragments are put together by the client
    if (info->opcode == SdoInfoOpcode::object_response) {
        EXPECT_TRUE(parse_object_description(info->data));
    } else if (info->opcode == SdoInfoOpcode::entry_response) {
        EXPECT_TRUE(parse_entry_description(info->data));
    } else if (info->opcode == SdoInfoOpcode::error) {
        EXPECT_TRUE(parse_info_error(info->data));
    }
}

Messages read_mailboxes(const std::filesystem::path& file) {
    Messages seen;
    Mailboxes mailboxes;
    for_each_answer(file, [&](const Datagram& datagram) {
        mailboxes.learn(datagram);
        const bool request = mailboxes.is_request(datagram), answer = mailboxes.is_answer(datagram);
        if (!request && !answer) return;
        const auto message = parse_mailbox(datagram.data);
        ASSERT_TRUE(message) << "a mailbox message that is not understood";
        ++(request ? seen.requests : seen.answers);
        if (message->header.type != MailboxType::coe) {
            ++seen.others;
            return;
        }
        const auto service = coe_service(message->payload);
        ASSERT_TRUE(service);
        switch (*service) {
            case CoeService::sdo_request:
                check_sdo(message->payload, seen);
                check_upload_request(message->payload);
                break;
            case CoeService::sdo_response: check_sdo(message->payload, seen); break;
            case CoeService::sdo_info: check_info(message->payload, seen); break;
            case CoeService::emergency:
                ++seen.emergencies;
                EXPECT_TRUE(parse_emergency(message->payload));
                break;
            default: ADD_FAILURE() << "CoE service " << static_cast<int>(*service); break;
        }
    });
    return seen;
}

TEST(RecordedAnswers, EveryMailboxMessageIsUnderstood) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    std::size_t answers = 0;
    for (const auto& file : test::capture_files()) {
        SCOPED_TRACE(file.filename());
        const Messages seen = read_mailboxes(file);
        answers += seen.answers;
        EXPECT_EQ(seen.others, 0u);
    }
    // tshark 4.0.17 counts 144 mailbox frames in the five recordings (3, 36, 105): each request as it leaves and as it comes back, and its answer.
    EXPECT_EQ(answers, 144u / 3);
}

TEST(RecordedAnswers, EveryAlStatusIsAKnownStateAndEveryCodeHasAText) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    std::map<AlState, std::size_t> states;
    for (const auto& file : test::capture_files()) {
        SCOPED_TRACE(file.filename());
        for_each_answer(file, [&](const Datagram& datagram) {
            // One slave's own answer: a broadcast ORs the states of all.
            if (!is_read(datagram.command) || datagram.address.ado() != reg::al_status || datagram.data.size() < 2) return;
            const auto status = load_le<std::uint16_t>(datagram.data);
            ++states[al_state(status)];
            EXPECT_NE(al_state(status), AlState::unknown) << std::hex << status;
            if ((status & al_status_error) != 0 && datagram.data.size() >= 6) {
                EXPECT_NE(al_status_info(load_le<std::uint16_t>(datagram.data, 4)).code, 0xFFFF);
            }
        });
    }
    EXPECT_GT(states[AlState::preop], 0u);
    EXPECT_GT(states[AlState::safeop] + states[AlState::op], 0u);
}

/// The EEPROM words that a recording's master read: command and word address written to 0502h, data read from 0508h.
std::map<std::uint16_t, std::vector<std::byte>> recorded_images(const std::filesystem::path& file) {
    std::map<std::uint16_t, std::vector<std::byte>> images;
    std::map<std::uint16_t, std::uint32_t> word;
    for_each_answer(file, [&](const Datagram& datagram) {
        const std::uint16_t slave = datagram.address.adp(), from = datagram.address.ado();
        if (datagram.command == Command::FPWR && from == reg::eeprom_control && datagram.data.size() >= 6 &&
            (load_le<std::uint16_t>(datagram.data) & eeprom::command_mask) == eeprom::read)
            word[slave] = load_le<std::uint32_t>(datagram.data, 2);
        if (datagram.command != Command::FPRD || from > reg::eeprom_data || from < reg::eeprom_control || !word.contains(slave)) return;
        const std::size_t skip = reg::eeprom_data - from;
        if (datagram.data.size() < skip + 4) return;
        const auto data = datagram.data.subspan(skip);
        auto& image = images[slave];
        const std::size_t at = 2 * std::size_t{word[slave]};
        if (at > 0x4000) return;
        if (image.size() < at + data.size()) image.resize(at + data.size(), std::byte{0});
        std::copy(data.begin(), data.end(), image.begin() + static_cast<std::ptrdiff_t>(at));
    });
    return images;
}

TEST(RecordedAnswers, EepromsThatOtherMastersReadGiveTheIdentitiesOfTheRealDevices) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto images = recorded_images(test::captures_folder() / "replay-ek1100-el2828-el2889.pcapng");
    std::vector<std::uint32_t> products;
    for (const auto& [station, image] : images) {
        const auto sii = parse_sii(image);
        EXPECT_EQ(sii.identity.vendor, 2u);
        products.push_back(sii.identity.product);
    }
    // A Beckhoff product code holds the type number in its upper half: 1100 = 044Ch, 2828 = 0B0Ch, 2889 = 0B49h.
    ASSERT_EQ(products.size(), 3u);
    EXPECT_EQ(products[0] >> 16, 0x044Cu);
    EXPECT_EQ(products[1] >> 16, 0x0B0Cu);
    EXPECT_EQ(products[2] >> 16, 0x0B49u);
}

}  // namespace
}  // namespace taktwerk::ecat
