//! Buffers for outputs that a host leaves out.

/// Channels of every port: all are stereo.
pub const CHANNELS: usize = 2;

/// Longest buffer prepared for when a host announces none or a tiny one.
const LEAST_FRAMES: usize = 8192;

/// Longest buffer prepared for, whatever a host announces: 20 s at 48 kHz, where no host's own buffers would end.
const MOST_FRAMES: usize = 1 << 20;

/// Scratch for every channel of every declared port, and the table of pointers that a port is passed as.
pub struct Scratch {
    frames: usize,
    /// `[port][channel]`.
    channels: Vec<[Vec<f32>; CHANNELS]>,
    /// `[port][channel]`: the host's, or scratch.
    pointers: Vec<[*mut f32; CHANNELS]>,
}

// SAFETY: the pointers are only followed during the call that filled them in.
unsafe impl Send for Scratch {}
// SAFETY: as above; shared access reads no pointer.
unsafe impl Sync for Scratch {}

impl Scratch {
    /// For a number of declared ports; has no room before [`prepare`](Self::prepare).
    pub fn new(ports: usize) -> Scratch {
        Scratch {
            frames: 0,
            channels: vec![[Vec::new(), Vec::new()]; ports],
            pointers: vec![[std::ptr::null_mut(); CHANNELS]; ports],
        }
    }

    /// Makes room for buffers of up to `frames`, or a million where a host announces more. Allocates.
    pub fn prepare(&mut self, frames: usize) {
        self.frames = frames.clamp(LEAST_FRAMES, MOST_FRAMES);
        for channel in self.channels.iter_mut().flatten() {
            channel.resize(self.frames, 0.0);
        }
    }

    /// Declared ports.
    pub fn ports(&self) -> usize {
        self.channels.len()
    }

    /// Fills in the pointers of every port for a buffer of `frames`: the host's channel where it gives one,
    /// scratch elsewhere. Returns `None` if scratch is needed and too short.
    ///
    /// # Safety
    /// `given` answers a port with null or with a table of at least that many channel pointers, each null or valid
    /// for `frames` samples; all must stay so while the result is in use.
    ///
    /// # Real-time
    /// No allocation.
    pub unsafe fn complete(
        &mut self,
        frames: usize,
        given: impl Fn(usize) -> (*mut *mut f32, usize),
    ) -> Option<&mut [[*mut f32; CHANNELS]]> {
        for (port, (scratch, pointers)) in self.channels.iter_mut().zip(&mut self.pointers).enumerate() {
            let (table, count) = given(port);
            for (channel, (scratch, pointer)) in scratch.iter_mut().zip(pointers).enumerate() {
                // SAFETY: the caller's promise about tables.
                let host = if table.is_null() || channel >= count {
                    std::ptr::null_mut()
                } else {
                    unsafe { *table.add(channel) }
                };
                *pointer = match host.is_null() {
                    false => host,
                    true if frames <= self.frames => scratch.as_mut_ptr(),
                    true => return None,
                };
            }
        }
        Some(&mut self.pointers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_host_gives_is_used_and_the_rest_completed() {
        let mut scratch = Scratch::new(3);
        scratch.prepare(64);
        let mut left = [0.0_f32; 64];
        let mut tables = [[left.as_mut_ptr(), std::ptr::null_mut()], [std::ptr::null_mut(); 2]];
        let [main, aux] = tables.each_mut().map(|table| table.as_mut_ptr());
        let given = |port| [(main, 2), (aux, 2), (std::ptr::null_mut(), 0)][port];
        // SAFETY: the tables hold two pointers each.
        let completed = unsafe { scratch.complete(64, given) }.unwrap();
        assert_eq!(completed[0][0], left.as_mut_ptr());
        let mut all: Vec<_> = completed.iter().flatten().copied().collect();
        assert!(all.iter().all(|pointer| !pointer.is_null()));
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 6, "two channels share a buffer");
    }

    #[test]
    fn an_absurd_announcement_does_not_exhaust_memory() {
        let mut scratch = Scratch::new(1);
        scratch.prepare(u32::MAX as usize);
        // SAFETY: no tables are given.
        unsafe {
            assert!(scratch.complete(MOST_FRAMES, |_| (std::ptr::null_mut(), 0)).is_some());
            assert!(scratch.complete(MOST_FRAMES + 1, |_| (std::ptr::null_mut(), 0)).is_none());
        }
    }

    #[test]
    fn a_buffer_longer_than_announced_is_refused_only_if_something_is_missing() {
        let mut scratch = Scratch::new(1);
        scratch.prepare(16);
        let frames = LEAST_FRAMES + 1;
        let mut buffers = [vec![0.0_f32; frames], vec![0.0_f32; frames]];
        let mut table = buffers.each_mut().map(|buffer| buffer.as_mut_ptr());
        let table = table.as_mut_ptr();
        // SAFETY: the table holds two pointers to that many samples, and the null one none.
        unsafe {
            assert!(scratch.complete(frames, |_| (table, 2)).is_some());
            assert!(scratch.complete(frames, |_| (table, 1)).is_none());
            assert!(scratch.complete(frames, |_| (std::ptr::null_mut(), 2)).is_none());
        }
    }
}
