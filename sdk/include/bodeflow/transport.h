#ifndef BODEFLOW_TRANSPORT_H
#define BODEFLOW_TRANSPORT_H

/* Topics of the network, as a service of the host. What travels is the struct bodeflow::Message of bodeflow.idl, so that any
 * DDS program can take part. A block asks for it by id: host->extension(host, BF_EXTENSION_TRANSPORT); NULL: the host has none.
 */

#include <bodeflow/abi.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BF_EXTENSION_TRANSPORT "bodeflow.transport/1"

enum {
  BF_MESSAGE_NONE = 0,
  BF_MESSAGE_SAMPLES = 1, /* channel after channel */
  BF_MESSAGE_RECORD = 2,  /* the bytes of a record; `position` / `rate.num` is its time in seconds */
  BF_MESSAGE_END = 4      /* nothing more comes */
};

enum {
  BF_TOPIC_LATEST = 1,    /* not each message, but the newest; a writer never waits */
  BF_TOPIC_KEEPS_LAST = 2 /* a reader that comes late gets the last message */
};

typedef struct bf_topic {
  uint32_t struct_size;
  uint32_t flags;
  const char* name;
  uint32_t domain;      /* of DDS; programs of different domains never meet */
  uint32_t readers;     /* of a writer: how many must be there before anything is sent */
  double tolerance_s;   /* without any progress for this long a call fails */
  uint64_t queue_bytes; /* what may be under way */
} bf_topic;

typedef struct bf_part {
  const uint8_t* bytes;
  uint64_t size;
} bf_part;

typedef struct bf_topic_message {
  uint32_t struct_size;
  uint32_t kind; /* BF_MESSAGE_... */
  uint32_t element;
  uint32_t channels;
  int64_t position; /* of the first sample */
  uint64_t count;   /* samples a channel */
  bf_rate rate;
  int64_t source_ns;    /* read only: the writer's wall clock */
  const char* clock;    /* clock domain */
  const bf_part* parts; /* the payload, one after the other; one part when read, 64-byte aligned */
  uint64_t part_count;
} bf_topic_message;

typedef struct bf_transport {
  uint32_t struct_size;
  uint32_t reserved;
  void* context;
  /* [control] NULL: host->error tells why. */
  void* (*open_writer)(const struct bf_transport* transport, const bf_host* host, const bf_topic* topic);
  void* (*open_reader)(const struct bf_transport* transport, const bf_host* host, const bf_topic* topic);
  /* [process] Waits for readers and for room. */
  int32_t (*write)(const bf_host* host, void* writer, const bf_topic_message* message);
  /* [process] Waits until everything has reached the readers. */
  int32_t (*flush)(const bf_host* host, void* writer);
  /* [process] The next message, which lives until the next call; waits for at most `seconds`, or with seconds < 0 for the
   * tolerance. None came in `seconds`: kind is BF_MESSAGE_NONE. */
  int32_t (*read)(const bf_host* host, void* reader, double seconds, bf_topic_message* message);
  /* [control] */
  void (*close_writer)(void* writer);
  void (*close_reader)(void* reader);
} bf_transport;

#ifdef __cplusplus
}
#endif

#endif
