// Slaves that lie to the master: now and then a byte of an answer, or its working counter, is another one, from the first datagram of the
// bring-up on. Whatever registers, EEPROM, mailboxes and process data say, the bring-up ends, in operation or with an error that has a
// sentence, and the bus can be taken down. Input: lies of [datagrams left alone until then, place, bits that flip].
#include <cstdlib>

#include "ecat/wire/frame.hpp"
#include "tests/ecat/test_bus.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;
using namespace std::chrono_literals;

namespace {

/// Between the slaves and the cable.
class Liar final : public FrameSink {
public:
    Liar(FrameSink& slaves, std::span<const std::uint8_t> lies) : slaves_(slaves), lies_(lies) { next(); }
    void advance(Instant now) noexcept override { slaves_.advance(now); }
    std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept override {
        const auto flight = slaves_.process(frame, now);
        FrameEditor editor{frame};
        while (auto datagram = editor.next()) {
            if (lies_.size() < 3) break;
            if (wait_ > 0) {
                --wait_;
                continue;
            }
            const std::size_t place = lies_[1] % (datagram->data.size() + datagram->wkc.size());
            auto& told = place < datagram->data.size() ? datagram->data[place] : datagram->wkc[place - datagram->data.size()];
            told ^= static_cast<std::byte>(lies_[2]);
            lies_ = lies_.subspan(3);
            next();
        }
        return flight;
    }

private:
    /// A bring-up of two slaves is some thousand datagrams: far ones are reached too, and near ones exactly.
    void next() { wait_ = lies_.empty() ? 0 : std::size_t{lies_[0]} * (lies_[0] < 128 ? 1 : 16); }
    FrameSink& slaves_;
    std::span<const std::uint8_t> lies_;
    std::size_t wait_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 300) return -1;  // more lies are no deeper, only slower
    test::TestBus bus{"st"};
    Liar liar{bus.network, {data, size}};
    bus.transport.plug_into(liar);
    (void)bus.bring_up(60s);
    const auto phase = bus.master->phase();
    if (phase != Master::Phase::operational && phase != Master::Phase::failed) std::abort();
    if (phase == Master::Phase::failed && bus.master->failure().what.empty()) std::abort();
    bus.run_for(300ms);
    std::array<AlarmFact, 32> facts;
    const auto count = bus.master->active_faults(facts);
    for (std::size_t i = 0; i < count; ++i) (void)bus.master->detail(facts[i]);
    bus.master->stop();
    if (!bus.run_until([&] { return bus.master->phase() == Master::Phase::stopped || bus.master->phase() == Master::Phase::failed; }, 60s))
        std::abort();
    return 0;
}
