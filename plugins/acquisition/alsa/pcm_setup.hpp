#pragma once

#include "pcm.hpp"

namespace bodeflow::acquisition {

/// Sets hardware and software parameters of an open device as `spec` asks, and writes the sizes granted to it.
Expected<void> set_up(snd_pcm_t* pcm, PcmSpec& spec);

/// "sound device 'hw:0' (capture)".
std::string name_of(const PcmSpec& spec);

}  // namespace bodeflow::acquisition
