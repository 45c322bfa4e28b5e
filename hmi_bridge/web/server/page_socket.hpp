#pragma once
// The WebSocket of a page: frames in and out, newest values first, whoever takes nothing or says too much is dropped. Included by web_server.cpp alone.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "hmi_bridge/web/outbox.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "hmi_bridge/web/server/beast.hpp"

namespace taktwerk::hmi::web {

class PageSocket : public std::enable_shared_from_this<PageSocket> {
public:
    explicit PageSocket(beast::tcp_stream&& stream) : ws_(std::move(stream)) {}
    virtual ~PageSocket() = default;
    PageSocket(const PageSocket&) = delete;
    PageSocket& operator=(const PageSocket&) = delete;

    template <class Request>
    void accept(const Request& request) {
        auto& stream = beast::get_lowest_layer(ws_);
        stream.expires_never();
        error_code ignored;
        stream.socket().set_option(asio::socket_base::send_buffer_size(send_buffer), ignored);
        stream.socket().set_option(tcp::no_delay(true), ignored);
        auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
        timeout.idle_timeout = 20s;
        timeout.keep_alive_pings = true;
        ws_.set_option(timeout);
        ws_.read_message_max(PageMessage::longest);
        ws_.text(true);
        // A page that says goodbye holds nothing any more, also when its connection stays: Beast reads until it closes that, too.
        ws_.control_callback([weak = weak_from_this()](websocket::frame_type kind, beast::string_view) {
            const auto self = weak.lock();
            if (self && kind == websocket::frame_type::close) asio::post(self->ws_.get_executor(), [self] { self->on_end(); });
        });
        ws_.async_accept(request, [self = shared_from_this()](error_code failure) {
            if (failure) return self->end();
            self->open_ = true;
            self->on_open();
            self->read();
        });
    }
    void end() {
        if (ended_) return;
        ended_ = true;
        open_ = false;
        beast::get_lowest_layer(ws_).close();
        on_end();
    }
    [[nodiscard]] bool is_open() const { return open_; }
    [[nodiscard]] bool ended() const { return ended_; }

protected:
    virtual void on_open() = 0;
    virtual void on_text(const std::string& text) = 0;
    virtual void on_end() = 0;  ///< also twice

    /// Drops a page that has taken nothing for too long.
    void expire(Instant at) {
        if (writing_ && at - write_began_ > page_patience) end();
    }
    void put(std::string message) {
        out_.put(std::move(message));
        write();
    }
    void put_answer(std::string message) {
        out_.put_answer(std::move(message));
        write();
    }
    void put_state(Outbox::Text values, Instant got) {
        if (!open_) return;
        out_.put_state(std::move(values), got);
        write();
    }
    void drop_state() { out_.drop_state(); }

private:
    static constexpr Duration page_patience = 2s;
    static constexpr int most_messages_a_second = 200;
    static constexpr int send_buffer = 64 * 1024;       ///< the kernel must not hide for long that a page takes nothing
    static constexpr std::size_t fragment = 64 * 1024;  ///< of a frame: so much has to go within page_patience

    void write() {
        if (writing_ || !open_) return;
        sending_ = out_.next(now());
        sent_ = 0;
        if (sending_) write_part();
    }
    void write_part() {
        writing_ = true;
        write_began_ = now();
        const auto part = std::min(fragment, sending_->size() - sent_);
        sent_ += part;
        ws_.async_write_some(sent_ == sending_->size(), asio::buffer(sending_->data() + sent_ - part, part),
                             [self = shared_from_this()](error_code failure, std::size_t) {
                                 self->writing_ = false;
                                 if (failure) return self->end();
                                 if (!self->open_) return;
                                 if (self->sent_ < self->sending_->size()) return self->write_part();
                                 self->write();
                             });
    }
    void read() {
        ws_.async_read(in_, [self = shared_from_this()](error_code failure, std::size_t) {
            if (failure || !self->ws_.got_text() || self->too_many()) return self->end();
            const auto text = beast::buffers_to_string(self->in_.data());
            self->in_.consume(self->in_.size());
            self->on_text(text);
            if (!self->ended_) self->read();
        });
    }
    bool too_many() {
        const auto at = now();
        if (at - second_began_ >= 1s) {
            second_began_ = at;
            messages_ = 0;
        }
        return ++messages_ > most_messages_a_second;
    }

    websocket::stream<beast::tcp_stream> ws_;
    beast::flat_buffer in_;
    Outbox out_;
    Outbox::Text sending_;
    std::size_t sent_ = 0;  ///< of `sending_`
    Instant write_began_{}, second_began_{};
    int messages_ = 0;
    bool open_ = false, ended_ = false, writing_ = false;
};

}  // namespace taktwerk::hmi::web
