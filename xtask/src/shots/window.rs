//! A host's window under X11, and screenshots of it.

use std::collections::HashSet;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt, CreateWindowAux, ImageFormat, WindowClass};
use x11rb::rust_connection::RustConnection;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT};

use overhear_cli::host::Instance;
use overhear_measure::picture;

/// How long an editor may take to appear: a virtual display draws in software.
const PATIENCE: Duration = Duration::from_secs(30);

/// Shades that text alone gives: with fewer nothing is drawn yet.
const SHADES: usize = 40;

/// A window that an editor is opened in.
pub struct HostWindow {
    connection: RustConnection,
    window: u32,
    size: (u16, u16),
}

impl HostWindow {
    /// Opens a window on the display of the environment.
    ///
    /// # Errors
    /// If there is no display.
    pub fn open(width: u32, height: u32) -> Result<HostWindow> {
        let (connection, screen) = x11rb::connect(None).context("no display")?;
        let root = connection.setup().roots.get(screen).context("no screen")?.root;
        let window = connection.generate_id()?;
        let size = (u16::try_from(width)?, u16::try_from(height)?);
        let class = WindowClass::INPUT_OUTPUT;
        let plain = CreateWindowAux::new();
        let depth = COPY_DEPTH_FROM_PARENT;
        connection.create_window(
            depth,
            window,
            root,
            0,
            0,
            size.0,
            size.1,
            0,
            class,
            COPY_FROM_PARENT,
            &plain,
        )?;
        connection.map_window(window)?;
        // Into the farthest corner, because widgets under a pointer look different.
        connection.warp_pointer(x11rb::NONE, root, 0, 0, 0, 0, i16::MAX, i16::MAX)?;
        // A round trip to the server, so that the window exists when the editor looks for it.
        connection.get_input_focus()?.reply()?;
        Ok(HostWindow { connection, window, size })
    }

    /// Its id.
    pub fn id(&self) -> u32 {
        self.window
    }

    /// Waits until something is drawn.
    ///
    /// # Errors
    /// If the window stays blank.
    pub fn wait(&self, instance: &mut Instance) -> Result<()> {
        let begun = Instant::now();
        while self.shades()? < SHADES {
            ensure!(begun.elapsed() < PATIENCE, "the editor stays blank");
            instance.answer();
            thread::sleep(Duration::from_millis(30));
        }
        Ok(())
    }

    fn shades(&self) -> Result<usize> {
        let pixels = self.pixels()?;
        Ok(pixels.chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect::<HashSet<_>>().len())
    }

    /// A screenshot as PNG.
    ///
    /// # Errors
    /// If the display does not tell.
    pub fn png(&self) -> Result<Vec<u8>> {
        picture::encode(&self.pixels()?, (u32::from(self.size.0), u32::from(self.size.1)))
    }

    /// A screenshot, row by row: red, green, blue.
    ///
    /// # Errors
    /// If the display does not tell.
    pub fn pixels(&self) -> Result<Vec<u8>> {
        let (width, height) = self.size;
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, width, height, !0)?
            .reply()?;
        Ok(image.data.chunks_exact(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect())
    }
}
