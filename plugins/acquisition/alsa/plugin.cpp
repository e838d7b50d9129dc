#include "capture_block.hpp"
#include "duplex_block.hpp"
#include "playback_block.hpp"

BODEFLOW_PLUGIN("acquisition_alsa", "0.1.0", bodeflow::acquisition::AlsaCapture, bodeflow::acquisition::AlsaDuplex,
                bodeflow::acquisition::AlsaPlayback)
