// Any bytes as what a slave puts into its mailbox while the master reads and writes objects: each transfer ends, with a value or with
// an error that has a sentence. Input: [what is asked], then the answers one after the other: [size, bytes], as they stand or (size odd)
// behind a header that is right.
#include <algorithm>
#include <cstdlib>
#include <deque>
#include <optional>
#include <vector>

#include "ecat/coe/object_info.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/transport/loopback.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/ecat/coe/scripted_mailbox.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;
using namespace std::chrono_literals;

namespace {

constexpr auto out_start = test::ScriptedMailbox::out_start, in_start = test::ScriptedMailbox::in_start,
               box_size = test::ScriptedMailbox::box_size;
using Bytes = std::vector<std::byte>;

/// One answer a request.
class MailboxSlave final : public test::ScriptedMailbox {
public:
    std::deque<Bytes> script;

private:
    void request(std::span<const std::byte>) override {
        if (!script.empty()) put_out(std::move(script.front())), script.pop_front();
    }
};

template <class T>
Script<void> keep(Script<Result<T>> script, std::optional<Error>& error, bool& ended) {
    const Result<T> value = co_await script;
    if (!value) error = value.error();
    ended = true;
}

template <class T>
void run(MailboxSlave& slave, auto make) {
    LoopbackTransport transport{slave};
    Exchange exchange{transport};
    AcyclicChannel channel{exchange};
    DatagramPort port{channel};
    EmergencyLog log;
    MailboxEndpoint mailbox;
    mailbox.subject = "slave";
    mailbox.station = 0x1001;
    mailbox.log = &log;
    mailbox.out_start = out_start;
    mailbox.in_start = in_start;
    mailbox.out_size = mailbox.in_size = box_size;
    std::optional<Error> error;
    bool ended = false;
    Runner runner{keep<T>(make(port, mailbox), error, ended)};
    Instant now{};
    for (int i = 0; i < 5000 && !runner.done(); ++i) {
        now += 100ms;  // time-outs are most of a run
        exchange.receive(now);
        channel.collect(now);
        runner.step(now);
        channel.pack(now, 16);
    }
    if (!ended) std::abort();  // no slave holds the master's script for ever
    if (error && error->what.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    MailboxSlave slave;
    for (std::size_t at = 1; at + 1 <= size && slave.script.size() < 64;) {
        const bool framed = (data[at] & 1) != 0;
        const std::size_t length = std::min<std::size_t>(data[at] / 2, size - at - 1);
        const auto* from = reinterpret_cast<const std::byte*>(data + at + 1);
        at += 1 + length;
        Bytes message(box_size);
        const auto offset = framed ? mailbox_header_size : 0;
        const auto carried = std::min<std::size_t>(length, box_size - offset);
        std::copy_n(from, carried, message.begin() + static_cast<std::ptrdiff_t>(offset));
        if (framed) finish_mailbox(message, MailboxType::coe, 1, carried);
        slave.script.push_back(std::move(message));
    }
    switch (data[0] % 7) {
        case 0: run<Bytes>(slave, [](auto& port, auto& mailbox) { return sdo_upload(port, mailbox, 0x1008, 0); }); break;
        case 1: run<void>(slave, [](auto& port, auto& mailbox) { return sdo_download(port, mailbox, 0x2001, 0, Bytes(200)); }); break;
        case 2:
            run<Bytes>(slave, [](auto& port, auto& mailbox) { return sdo_upload(port, mailbox, 0x1C12, 1, SdoAccess::complete); });
            break;
        case 3:
            run<std::vector<std::uint16_t>>(slave, [](auto& port, auto& mailbox) { return list_objects(port, mailbox, ObjectList::all); });
            break;
        case 4: run<ObjectInfo>(slave, [](auto& port, auto& mailbox) { return describe_object(port, mailbox, 0x1018); }); break;
        case 5: run<EntryInfo>(slave, [](auto& port, auto& mailbox) { return describe_entry(port, mailbox, 0x1018, 1); }); break;
        default: run<std::vector<Bytes>>(slave, [](auto& port, auto& mailbox) { return sdo_upload_list(port, mailbox, 0x1600, 4); });
    }
    return 0;
}
