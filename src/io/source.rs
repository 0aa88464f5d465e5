//! Where a file comes from: unpacked if it is packed, its first bytes known, its fingerprint taken.

use std::io::{self, BufRead, BufReader, Chain, Cursor, Read};

use flate2::bufread::MultiGzDecoder;
use sha2::{Digest, Sha256};

use super::fault::{Located, whole};
use super::{ReadFault, ReadOptions};

/// So many bytes, or the whole file, are there when a reader first looks.
const START: u64 = 1024;
/// How much a packed file may have unpacked whatever its size.
const FREE: u64 = 64 << 20;

/// A source whose first bytes are all in its first buffer.
type Started<R> = Chain<Cursor<Vec<u8>>, BufReader<R>>;

fn started<R: Read>(mut source: R) -> io::Result<Started<R>> {
    let mut start = Vec::new();
    source.by_ref().take(START).read_to_end(&mut start)?;
    Ok(Cursor::new(start).chain(BufReader::with_capacity(1 << 16, source)))
}

/// Counts and digests what is read.
pub(super) struct Fingerprinted<R> {
    source: R,
    digest: Sha256,
    length: u64,
}

impl<R: Read> Fingerprinted<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, digest: Sha256::new(), length: 0 }
    }

    /// Gives the content of the file, unpacked, to `read`.
    pub(super) fn open<T>(
        &mut self,
        options: &ReadOptions,
        read: impl FnOnce(&mut dyn BufRead) -> Result<T, Located>,
    ) -> Result<T, Located> {
        let mut source = started(self).map_err(whole)?;
        if !source.fill_buf().map_err(whole)?.starts_with(b"\x1f\x8b") {
            return read(&mut source);
        }
        let decoder = MultiGzDecoder::new(source);
        let unpacked = Unpacked { decoder, length: 0, times: options.expansion };
        read(&mut started(unpacked).map_err(whole)?)
    }

    /// SHA-256 of what was read, in hexadecimal digits.
    pub(super) fn sha256(self) -> String {
        hex(&self.digest.finalize())
    }
}

/// SHA-256 of `bytes`, in hexadecimal digits.
#[must_use]
pub fn fingerprint(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

impl<R: Read> Read for Fingerprinted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.source.read(buffer)?;
        self.digest.update(&buffer[..n]);
        self.length += n as u64;
        Ok(n)
    }
}

/// Packed data on their way out, which must not become too many.
struct Unpacked<'a, R> {
    decoder: MultiGzDecoder<Started<&'a mut Fingerprinted<R>>>,
    length: u64,
    times: u32,
}

impl<R: Read> Read for Unpacked<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.decoder.read(buffer);
        let n = n.map_err(|e| io::Error::other(ReadFault::Packed(e)))?;
        self.length += n as u64;
        let packed = self.decoder.get_ref().get_ref().1.get_ref().length;
        if self.length > FREE.saturating_add(packed.saturating_mul(self.times.into())) {
            return Err(io::Error::other(ReadFault::Expansion { times: self.times }));
        }
        Ok(n)
    }
}

/// Fills the buffer, or says what there is too little of.
pub(super) fn read_exactly(
    source: &mut dyn BufRead,
    buffer: &mut [u8],
    short: impl FnOnce() -> ReadFault,
) -> Result<(), ReadFault> {
    source.read_exact(buffer).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => short(),
        _ => error.into(),
    })
}
