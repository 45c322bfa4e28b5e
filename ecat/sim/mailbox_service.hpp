#pragma once
// A protocol behind a simulated slave's mailbox, beside CoE.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/wire/mailbox.hpp"

namespace taktwerk::ecat::sim {

class MailboxService {
public:
    /// The mailbox begins anew: PREOP or BOOT was entered from INIT.
    virtual void start() noexcept = 0;
    /// What the mailboxes hold in this state, without header: for whoever fills them to the last byte. Before start().
    virtual void set_rooms(std::size_t from_master, std::size_t to_master) noexcept = 0;
    /// A message came, without header. Size of the answer that is now in `out`; 0: none.
    virtual std::size_t serve(std::span<const std::byte> message, std::span<std::byte> out, EsmState state, Instant now) noexcept = 0;
    /// Something goes out although nobody asks (any more).
    [[nodiscard]] virtual bool pending() const noexcept { return false; }
    virtual std::size_t next(std::span<std::byte> out) noexcept {
        (void)out;
        return 0;
    }

protected:
    ~MailboxService() = default;
};

/// Those of one mailbox.
struct MailboxServices {
    MailboxService* files = nullptr;
    MailboxService* ethernet = nullptr;

    void attach(MailboxType type, MailboxService& service) noexcept { (type == MailboxType::foe ? files : ethernet) = &service; }
    [[nodiscard]] MailboxService* find(MailboxType type) const noexcept {
        return type == MailboxType::foe ? files : type == MailboxType::eoe ? ethernet : nullptr;
    }
    [[nodiscard]] bool pending() const noexcept { return ethernet != nullptr && ethernet->pending(); }
    void start(std::size_t from_master, std::size_t to_master) noexcept {
        for (MailboxService* service : {files, ethernet}) {
            if (service == nullptr) continue;
            service->set_rooms(from_master, to_master);
            service->start();
        }
    }
};

}  // namespace taktwerk::ecat::sim
