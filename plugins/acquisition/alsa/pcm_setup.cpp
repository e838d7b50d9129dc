#include "pcm_setup.hpp"

#include <alsa/asoundlib.h>

namespace bodeflow::acquisition {
namespace {

snd_pcm_format_t alsa_format(SampleFormat format) {
  switch (format) {
    case SampleFormat::s16:
      return SND_PCM_FORMAT_S16_LE;
    case SampleFormat::s24:
      return SND_PCM_FORMAT_S24_LE;
    case SampleFormat::s24_3le:
      return SND_PCM_FORMAT_S24_3LE;
    case SampleFormat::s32:
      return SND_PCM_FORMAT_S32_LE;
    case SampleFormat::f32:
      return SND_PCM_FORMAT_FLOAT_LE;
  }
  return SND_PCM_FORMAT_UNKNOWN;
}

/// Narrows the hardware parameters of one device step by step.
class Hardware {
 public:
  Hardware(snd_pcm_t* pcm, PcmSpec& spec) : pcm_(pcm), spec_(spec) { snd_pcm_hw_params_malloc(&params_); }
  ~Hardware() { snd_pcm_hw_params_free(params_); }
  Hardware(const Hardware&) = delete;
  Hardware& operator=(const Hardware&) = delete;

  Expected<void> apply() {
    if (params_ == nullptr) return refused("no memory for its parameters");
    if (const int code = snd_pcm_hw_params_any(pcm_, params_); code < 0) return refused("has no configuration", code);
    snd_pcm_hw_params_set_rate_resample(pcm_, params_, 0);  // a conversion on the way would not be what was asked for
    if (const int code = snd_pcm_hw_params_set_access(pcm_, params_, SND_PCM_ACCESS_RW_INTERLEAVED); code < 0)
      return refused("has no interleaved access", code);
    for (const auto step : {&Hardware::format, &Hardware::channels, &Hardware::rate, &Hardware::sizes})
      if (auto done = (this->*step)(); !done) return done;
    if (const int code = snd_pcm_hw_params(pcm_, params_); code < 0) return refused("refuses its parameters", code);
    return {};
  }

 private:
  Unexpected<Error> refused(const std::string& what, int code = 0) const {
    return unexpected(name_of(spec_) + " " + what + (code < 0 ? std::string(": ") + snd_strerror(code) : std::string()));
  }

  Expected<void> format() {
    if (snd_pcm_hw_params_set_format(pcm_, params_, alsa_format(spec_.format)) >= 0) return {};
    std::string allowed;
    for (const std::string& name : sample_formats())
      if (snd_pcm_hw_params_test_format(pcm_, params_, alsa_format(*sample_format(name))) == 0)
        allowed += (allowed.empty() ? "" : ", ") + name;
    return refused("has no format " + std::string(name_of(spec_.format)) +
                   "; allowed: " + (allowed.empty() ? "none of ours" : allowed));
  }

  Expected<void> channels() {
    if (snd_pcm_hw_params_set_channels(pcm_, params_, spec_.channels) >= 0) return {};
    unsigned least = 0, most = 0;
    snd_pcm_hw_params_get_channels_min(params_, &least);
    snd_pcm_hw_params_get_channels_max(params_, &most);
    return refused("does not run with " + std::to_string(spec_.channels) + " channels; allowed: " + std::to_string(least) +
                   " to " + std::to_string(most));
  }

  Expected<void> rate() {
    if (snd_pcm_hw_params_set_rate(pcm_, params_, spec_.rate_hz, 0) >= 0) return {};
    unsigned least = 0, most = 0;
    int direction = 0;
    snd_pcm_hw_params_get_rate_min(params_, &least, &direction);
    snd_pcm_hw_params_get_rate_max(params_, &most, &direction);
    return refused("does not run at " + std::to_string(spec_.rate_hz) + " Hz; allowed: rates of its own from " +
                   std::to_string(least) + " to " + std::to_string(most) + " Hz");
  }

  Expected<void> sizes() {
    auto period = static_cast<snd_pcm_uframes_t>(spec_.period);
    int direction = 0;
    if (const int code = snd_pcm_hw_params_set_period_size_near(pcm_, params_, &period, &direction); code < 0)
      return refused("refuses a period of " + std::to_string(spec_.period) + " frames", code);
    auto buffer = static_cast<snd_pcm_uframes_t>(std::max(spec_.buffer, static_cast<std::size_t>(2 * period)));
    if (const int code = snd_pcm_hw_params_set_buffer_size_near(pcm_, params_, &buffer); code < 0)
      return refused("refuses a buffer of " + std::to_string(spec_.buffer) + " frames", code);
    spec_.period = period;
    spec_.buffer = buffer;
    return {};
  }

  snd_pcm_t* pcm_;
  PcmSpec& spec_;
  snd_pcm_hw_params_t* params_ = nullptr;
};

/// Starts when told alone, stops when its buffer is full or empty, stamps with the monotonic clock.
int apply_software(snd_pcm_t* pcm, const PcmSpec& spec) {
  snd_pcm_sw_params_t* params = nullptr;
  if (const int code = snd_pcm_sw_params_malloc(&params); code < 0) return code;
  snd_pcm_uframes_t boundary = 0;
  int code = snd_pcm_sw_params_current(pcm, params);
  if (code >= 0) code = snd_pcm_sw_params_get_boundary(params, &boundary);
  if (code >= 0) code = snd_pcm_sw_params_set_start_threshold(pcm, params, boundary);
  if (code >= 0) code = snd_pcm_sw_params_set_stop_threshold(pcm, params, spec.buffer);
  if (code >= 0) code = snd_pcm_sw_params_set_avail_min(pcm, params, spec.period);
  if (code >= 0) code = snd_pcm_sw_params_set_tstamp_mode(pcm, params, SND_PCM_TSTAMP_ENABLE);
  if (code >= 0) code = snd_pcm_sw_params_set_tstamp_type(pcm, params, SND_PCM_TSTAMP_TYPE_MONOTONIC);
  if (code >= 0) code = snd_pcm_sw_params(pcm, params);
  snd_pcm_sw_params_free(params);
  return code;
}

}  // namespace

std::string name_of(const PcmSpec& spec) {
  return "sound device '" + spec.device + "' (" + (spec.direction == Direction::capture ? "capture" : "playback") + ")";
}

Expected<void> set_up(snd_pcm_t* pcm, PcmSpec& spec) {
  if (auto done = Hardware(pcm, spec).apply(); !done) return done;
  if (const int code = apply_software(pcm, spec); code < 0)
    return unexpected(name_of(spec) + " refuses its software parameters: " + snd_strerror(code));
  return {};
}

}  // namespace bodeflow::acquisition
