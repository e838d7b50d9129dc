// A sound card for tests, as an I/O plug of libasound: what is played comes back through a filter, after a delay, with noise,
// paced by the monotonic clock. Of its settings in the ALSA configuration all but `type` may be left out:
//   delay N             samples from playback to capture
//   b [..]  a [..]      the filter: a second-order section, three numbers and two (behind the leading 1)
//   noise STD           white and normal, of full scale
//   ramp 1              capture gives (frame mod 2^15) / 2^15 instead: frames counted from the opening on, also while it stands
//   still overruns [..]       frames of the capture at which it breaks off, counted in the same way underruns [..]      frames of
//   the playback stall N             from this frame on the capture delivers nothing ppm X               deviation of its clock
// Playback and capture begin together once both were started; a capture that is opened alone begins by itself.
#define PIC 1
#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <random>
#include <vector>

namespace {

constexpr std::size_t kTape = std::size_t{1} << 17;  // frames, more than any buffer
constexpr int kChannels = 4;

struct Settings {
  long delay = 0, stall = -1;
  bool ramp = false;
  double noise = 0.0, ppm = 0.0;
  std::array<double, 3> b{1, 0, 0};
  std::array<double, 2> a{0, 0};
  std::vector<double> overruns, underruns;
};

double now_s() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Side {
  bool open = false, armed = false, broken = false;
  double opened_s = 0.0, started_s = -1.0;  // started: -1 while it stands still
  long moved = 0;                           // frames since prepare
  std::size_t next_break = 0;
};

/// The card: shared by both directions.
struct Card {
  std::mutex mutex;
  Settings settings;
  double rate = 48000;
  Side play, capture;
  std::array<std::vector<double>, kChannels> tape;
  std::array<std::array<double, 4>, kChannels> past{};
  std::mt19937_64 random{1};
  std::normal_distribution<double> normal;

  Card() {
    for (auto& channel : tape) channel.assign(kTape, 0.0);
  }

  double true_rate() const { return rate * (1 + 1e-6 * settings.ppm); }
  long frames(const Side& side) const {
    return side.started_s < 0 ? 0 : static_cast<long>(std::floor((now_s() - side.started_s) * true_rate()));
  }
  /// Frames since the side was opened, whether it ran or not.
  long since_opening(const Side& side, double time_s) const {
    return static_cast<long>(std::floor((time_s - side.opened_s) * true_rate()));
  }
  void begin_if_ready() {
    const bool ready = (play.armed || !play.open) && (capture.armed || !capture.open);
    if (!ready) return;
    const double now = now_s();
    for (Side* side : {&play, &capture})
      if (side->armed && side->started_s < 0) side->started_s = now;
  }
  double answer(std::size_t channel, long frame) {
    const long source = frame - settings.delay;
    const double x = source < 0 || source >= play.moved ? 0.0 : tape[channel][static_cast<std::size_t>(source) % kTape];
    auto& [x1, x2, y1, y2] = past[channel];
    const auto& [b0, b1, b2] = settings.b;
    const double y = b0 * x + b1 * x1 + b2 * x2 - settings.a[0] * y1 - settings.a[1] * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    return y + settings.noise * normal(random);
  }
};

Card& card() {
  static Card one;
  return one;
}

struct Plug {
  snd_pcm_ioplug_t io{};
  int timer = -1;
  snd_pcm_uframes_t boundary = 1;
};

Plug& plug(snd_pcm_ioplug_t* io) { return *static_cast<Plug*>(io->private_data); }
bool captures(const snd_pcm_ioplug_t* io) { return io->stream == SND_PCM_STREAM_CAPTURE; }
Side& side(const snd_pcm_ioplug_t* io) { return captures(io) ? card().capture : card().play; }

int prepare(snd_pcm_ioplug_t* io) {
  const std::lock_guard lock(card().mutex);
  card().rate = io->rate;
  Side& s = side(io);
  s.armed = s.broken = false;
  s.started_s = -1;
  s.moved = 0;
  if (s.opened_s == 0.0) s.opened_s = now_s();
  return 0;
}

int start(snd_pcm_ioplug_t* io) {
  const std::lock_guard lock(card().mutex);
  side(io).armed = true;
  card().begin_if_ready();
  return 0;
}

int stop(snd_pcm_ioplug_t* io) {
  const std::lock_guard lock(card().mutex);
  side(io).armed = false;
  side(io).started_s = -1;
  return 0;
}

snd_pcm_sframes_t pointer(snd_pcm_ioplug_t* io) {
  const std::lock_guard lock(card().mutex);
  Card& c = card();
  Side& s = side(io);
  if (s.broken) return -EPIPE;
  if (s.started_s < 0) return 0;
  const auto& breaks = captures(io) ? c.settings.overruns : c.settings.underruns;
  if (s.next_break < breaks.size() && static_cast<double>(c.since_opening(s, now_s())) >= breaks[s.next_break]) {
    ++s.next_break;
    s.broken = true;
    return -EPIPE;
  }
  long at = c.frames(s);
  if (captures(io) && c.settings.stall >= 0) at = std::min(at, c.settings.stall);
  const long lag = captures(io) ? at - s.moved : at - s.moved + static_cast<long>(io->buffer_size);
  if (lag > static_cast<long>(io->buffer_size)) return -EPIPE;
  return static_cast<snd_pcm_sframes_t>(static_cast<snd_pcm_uframes_t>(at) % plug(io).boundary);
}

std::uint8_t* place(const snd_pcm_channel_area_t& area, snd_pcm_uframes_t frame) {
  return static_cast<std::uint8_t*>(area.addr) + (area.first + frame * area.step) / 8;
}

double get(const std::uint8_t* at, snd_pcm_format_t format) {
  std::int16_t narrow = 0;
  std::int32_t wide = 0;
  if (format == SND_PCM_FORMAT_S16_LE) return std::memcpy(&narrow, at, 2), narrow / 32768.0;
  return std::memcpy(&wide, at, 4), wide / 2147483648.0;
}

void put(std::uint8_t* at, snd_pcm_format_t format, double value) {
  const double limited = std::clamp(value, -1.0, 1.0 - 0x1p-31);
  const auto narrow = static_cast<std::int16_t>(std::clamp(std::nearbyint(32768 * limited), -32768.0, 32767.0));
  const auto wide = static_cast<std::int32_t>(std::nearbyint(2147483648.0 * limited));
  if (format == SND_PCM_FORMAT_S16_LE) {
    std::memcpy(at, &narrow, 2);
  } else {
    std::memcpy(at, &wide, 4);
  }
}

snd_pcm_sframes_t transfer(snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas, snd_pcm_uframes_t offset,
                           snd_pcm_uframes_t size) {
  const std::lock_guard lock(card().mutex);
  Card& c = card();
  Side& s = side(io);
  const long ramp_begin = c.settings.ramp ? c.since_opening(s, s.started_s) : 0;
  for (snd_pcm_uframes_t n = 0; n < size; ++n, ++s.moved) {
    for (unsigned channel = 0; channel < io->channels; ++channel) {
      std::uint8_t* at = place(areas[channel], offset + n);
      if (!captures(io)) {
        c.tape[channel][static_cast<std::size_t>(s.moved) % kTape] = get(at, io->format);
      } else if (c.settings.ramp) {
        put(at, io->format, static_cast<double>((ramp_begin + s.moved) % 32768) / 32768.0);
      } else {
        put(at, io->format, c.answer(channel, s.moved));
      }
    }
  }
  return static_cast<snd_pcm_sframes_t>(size);
}

int sw_params(snd_pcm_ioplug_t* io, snd_pcm_sw_params_t* params) {
  return snd_pcm_sw_params_get_boundary(params, &plug(io).boundary);
}

int revents(snd_pcm_ioplug_t* io, pollfd* fds, unsigned, unsigned short* events) {
  std::uint64_t ticks = 0;
  const bool ticked = (fds[0].revents & POLLIN) != 0 && read(plug(io).timer, &ticks, sizeof ticks) > 0;
  *events = static_cast<unsigned short>(ticked ? (captures(io) ? POLLIN : POLLOUT) : 0);
  return 0;
}

int close_plug(snd_pcm_ioplug_t* io) {
  {
    const std::lock_guard lock(card().mutex);
    side(io) = Side();
  }
  close(plug(io).timer);
  delete &plug(io);
  return 0;
}

const snd_pcm_ioplug_callback_t* callbacks() {
  static const snd_pcm_ioplug_callback_t list = [] {
    snd_pcm_ioplug_callback_t c{};
    c.start = start;
    c.stop = stop;
    c.pointer = pointer;
    c.transfer = transfer;
    c.prepare = prepare;
    c.sw_params = sw_params;
    c.poll_revents = revents;
    c.close = close_plug;
    return c;
  }();
  return &list;
}

std::vector<double> numbers(snd_config_t* list) {
  std::vector<double> values;
  for (auto i = snd_config_iterator_first(list); i != snd_config_iterator_end(list); i = snd_config_iterator_next(i)) {
    double value = 0.0;
    if (snd_config_get_ireal(snd_config_iterator_entry(i), &value) >= 0) values.push_back(value);
  }
  return values;
}

int read_settings(snd_config_t* conf, Settings& settings) {
  for (auto i = snd_config_iterator_first(conf); i != snd_config_iterator_end(conf); i = snd_config_iterator_next(i)) {
    snd_config_t* entry = snd_config_iterator_entry(i);
    const char* id = nullptr;
    if (snd_config_get_id(entry, &id) < 0) continue;
    const std::string name = id;
    long whole = 0;
    if (name == "delay") snd_config_get_integer(entry, &settings.delay);
    if (name == "stall") snd_config_get_integer(entry, &settings.stall);
    if (name == "ramp" && snd_config_get_integer(entry, &whole) >= 0) settings.ramp = whole != 0;
    if (name == "noise") snd_config_get_ireal(entry, &settings.noise);
    if (name == "ppm") snd_config_get_ireal(entry, &settings.ppm);
    if (name == "overruns") settings.overruns = numbers(entry);
    if (name == "underruns") settings.underruns = numbers(entry);
    if (name == "b" || name == "a") {
      const auto values = numbers(entry);
      if (values.size() != (name == "b" ? 3 : 2)) return -EINVAL;
      std::copy(values.begin(), values.end(), name == "b" ? settings.b.begin() : settings.a.begin());
    }
  }
  return 0;
}

int constrain(snd_pcm_ioplug_t* io) {
  static const unsigned access[] = {SND_PCM_ACCESS_RW_INTERLEAVED};
  static const unsigned formats[] = {SND_PCM_FORMAT_S16_LE, SND_PCM_FORMAT_S32_LE};
  static const unsigned rates[] = {8000, 48000, 96000};
  int code = snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_ACCESS, 1, access);
  if (code >= 0) code = snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_FORMAT, 2, formats);
  if (code >= 0) code = snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_RATE, 3, rates);
  if (code >= 0) code = snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_CHANNELS, 1, kChannels);
  if (code >= 0) code = snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_PERIOD_BYTES, 64, 1 << 18);
  if (code >= 0) code = snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_BUFFER_BYTES, 128, 1 << 20);
  return code;
}

}  // namespace

extern "C" {
SND_PCM_PLUGIN_DEFINE_FUNC(bodeflow_loop) {
  (void)root;
  Settings settings;
  if (const int code = read_settings(conf, settings); code < 0) return code;
  auto made = std::make_unique<Plug>();
  made->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  const itimerspec every{{0, 1'000'000}, {0, 1'000'000}};
  if (made->timer < 0 || timerfd_settime(made->timer, 0, &every, nullptr) < 0) return -errno;
  snd_pcm_ioplug_t& io = made->io;
  io.version = SND_PCM_IOPLUG_VERSION;
  io.name = "loop of the tests";
  io.flags = SND_PCM_IOPLUG_FLAG_MONOTONIC | SND_PCM_IOPLUG_FLAG_BOUNDARY_WA;
  io.poll_fd = made->timer;
  io.poll_events = POLLIN;
  io.callback = callbacks();
  io.private_data = made.get();
  if (const int code = snd_pcm_ioplug_create(&io, name, stream, mode); code < 0) return code;
  {
    const std::lock_guard lock(card().mutex);
    card().settings = settings;
    side(&io) = Side();
    side(&io).open = true;
  }
  made.release();
  *pcmp = io.pcm;
  return constrain(&io);
}
SND_PCM_PLUGIN_SYMBOL(bodeflow_loop);
}
