#include "hmi_bridge/lcm/lcm_bus.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <lcm/lcm-cpp.hpp>

namespace taktwerk::hmi {
namespace {

/// Room for the commands of one service step and a burst; beyond it LCM drops the newest, and their clients repeat them.
constexpr int subscription_queue = 256;
/// A datagram that ends before its channel does has, as LCM counts, 4 GB and a few bytes less of data; and a first fragment may promise as much.
/// Nobody's message is so long, and reading one that is not there ends the process.
constexpr std::size_t longest_delivered = std::size_t{64} << 20;

/// LCM itself would only print "No route to" and a scrambled address. 0, or errno.
int multicast_problem(const LcmUrl& url) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return errno;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(url.port);
    ::inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
    const int problem = ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
    ::close(socket);
    return problem;
}

/// LCM and the library under it end the process where they lack a descriptor or the memory of a thread: asked before, it is an error.
std::optional<Error> no_room(const LcmUrl& url) {
    constexpr std::size_t descriptors = 16;                // sockets and pipes of its threads, with a margin
    constexpr std::size_t memory = std::size_t{64} << 20;  // stacks and buffers, likewise
    std::vector<int> probes;
    while (probes.size() < descriptors) {
        const int one = ::eventfd(0, EFD_CLOEXEC);
        if (one < 0) break;
        probes.push_back(one);
    }
    for (const int probe : probes) ::close(probe);
    if (probes.size() < descriptors)
        return Error{"hmi.lcm", url.text, fmt::format("LCM needs {} file descriptors, and only {} are left", descriptors, probes.size()),
                     "Raise the limit of open files (ulimit -n), or set `lcm: {enabled: false}`."};
    void* const space = ::mmap(nullptr, memory, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (space == MAP_FAILED)
        return Error{"hmi.lcm", url.text, fmt::format("LCM needs {} MiB of address space, and that is not left", memory >> 20),
                     "Raise the limit of memory (ulimit -v), or set `lcm: {enabled: false}`."};
    ::munmap(space, memory);
    return std::nullopt;
}

struct Subscriber {
    MessageBus::Handler handler;
    /// C code calls this: nothing may be thrown through it.
    void receive(const lcm::ReceiveBuffer* message, const std::string&) noexcept {
        if (message->data_size > longest_delivered) return;
        try {
            handler({static_cast<const std::byte*>(message->data), message->data_size});
        } catch (...) {
            // A handler that throws has lost its message; the next one is another chance.
        }
    }
};

struct ChannelSubscriber {
    LcmBus::ChannelHandler handler;
    void receive(const lcm::ReceiveBuffer* message, const std::string& channel) noexcept {
        if (message->data_size > longest_delivered) return;
        try {
            handler(channel, {static_cast<const std::byte*>(message->data), message->data_size}, message->recv_utime);
        } catch (...) {
            // As above.
        }
    }
};

/// LCM itself would print into the terminal and go on.
bool is_regular_expression(const std::string& pattern) {
    try {
        static_cast<void>(std::regex(pattern));
        return true;
    } catch (const std::regex_error&) {
        return false;
    }
}

}  // namespace

struct LcmBus::Impl {
    explicit Impl(const std::string& url) : lcm(url) {}
    std::vector<std::unique_ptr<Subscriber>> subscribers;
    std::vector<std::unique_ptr<ChannelSubscriber>> channel_subscribers;
    lcm::LCM lcm;
};

LcmBus::LcmBus(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LcmBus::~LcmBus() = default;

Result<std::unique_ptr<LcmBus>> LcmBus::open(const LcmUrl& url) {
    if (auto problem = no_room(url)) return *problem;
    if (url.provider == LcmUrl::Provider::udpm) {
        const int problem = multicast_problem(url);
        if (problem == ENETUNREACH || problem == EHOSTUNREACH)
            return Error{"hmi.no_multicast_route", url.text,
                         fmt::format("there is no route to the multicast group {}, so LCM cannot publish", url.group),
                         "Run as root: `ip link set lo multicast on` and `ip route add 224.0.0.0/4 dev lo`."};
        if (problem != 0)
            return Error{"hmi.lcm", url.text, fmt::format("LCM cannot use the network: {}", std::strerror(problem)),
                         "Check the network and the LCM URL."};
    }
    auto impl = std::make_unique<Impl>(url.text);
    if (!impl->lcm.good())
        return Error{"hmi.lcm", url.text, "LCM did not start; its own message stands above",
                     "Check the LCM URL, and whether the port is free for multicast."};
    return std::unique_ptr<LcmBus>(new LcmBus(std::move(impl)));
}

bool LcmBus::publish(std::string_view channel, std::span<const std::byte> message) {
    return impl_->lcm.publish(std::string(channel), message.data(), static_cast<unsigned>(message.size())) == 0;
}

void LcmBus::subscribe(std::string_view channel, Handler handler) {
    auto& subscriber = impl_->subscribers.emplace_back(std::make_unique<Subscriber>());
    subscriber->handler = std::move(handler);
    if (auto* subscription = impl_->lcm.subscribe(std::string(channel), &Subscriber::receive, subscriber.get()))
        subscription->setQueueCapacity(subscription_queue);
}

bool LcmBus::subscribe_matching(const std::string& pattern, int room, ChannelHandler handler) {
    if (!is_regular_expression(pattern)) return false;
    auto& subscriber = impl_->channel_subscribers.emplace_back(std::make_unique<ChannelSubscriber>());
    subscriber->handler = std::move(handler);
    auto* subscription = impl_->lcm.subscribe(pattern, &ChannelSubscriber::receive, subscriber.get());
    if (subscription == nullptr) return false;
    subscription->setQueueCapacity(room);
    return true;
}

int LcmBus::descriptor() const { return impl_->lcm.getFileno(); }

int LcmBus::wait(Duration patience, int most) {
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
    return impl_->lcm.handleTimeout(static_cast<int>(ms)) > 0 ? 1 + poll(most - 1) : 0;
}

int LcmBus::poll(int most) {
    int done = 0;
    while (done < most && impl_->lcm.handleTimeout(0) > 0) ++done;
    return done;
}

}  // namespace taktwerk::hmi
