//! Sending the image to the viewer tev over its protocol.

use std::io;
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::Duration;

use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

use crate::imaging::film::Film;

/// Where tev listens by default.
pub const TEV_ADDRESS: &str = "127.0.0.1:14158";
/// A tev that takes longer to answer is not there.
const TIMEOUT: Duration = Duration::from_secs(3);
/// The channels, in the order of the film.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Shows `film` in the tev that listens at `address`, as an image called `name`; one of the same name
/// is replaced.
pub fn send_to_tev(address: &str, name: &str, film: &Film) -> io::Result<()> {
    let unknown = || io::Error::new(io::ErrorKind::NotFound, "there is no such address");
    let place = address.to_socket_addrs()?.next().ok_or_else(unknown)?;
    let socket = TcpStream::connect_timeout(&place, TIMEOUT)?;
    socket.set_write_timeout(Some(TIMEOUT))?;
    let mut tev = TevClient::wrap(socket);
    let [width, height] = film.size().map(|side| side as u32);
    if width == 0 || height == 0 {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "there is no image yet"));
    }
    // A name ends at the first zero on the wire.
    let name = name.replace('\0', "");
    tev.send(PacketCreateImage {
        image_name: &name,
        grab_focus: true,
        width,
        height,
        channel_names: &CHANNELS,
    })?;
    tev.send(PacketUpdateImage {
        image_name: &name,
        grab_focus: false,
        channel_names: &CHANNELS,
        channel_offsets: &[0, 1, 2],
        channel_strides: &[3, 3, 3],
        x: 0,
        y: 0,
        width,
        height,
        data: film.rgb(),
    })
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;
    use std::net::TcpListener;

    use common::FilmTile;

    use super::*;

    #[test]
    fn tev_gets_every_value() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("its address").to_string();
        let mut film = Film::default();
        let rgb = vec![0.5, 1.5, 2.5, 3.5, 4.5, 5.5];
        let tile =
            FilmTile { sequence: 1, width: 2, height: 1, first_row: 0, steps: 1, rgb: rgb.clone() };
        assert!(film.accept(&tile), "a whole image");
        let received = std::thread::scope(|scope| {
            let tev = scope.spawn(|| {
                let (mut socket, _) = listener.accept().expect("a connection");
                let mut bytes = Vec::new();
                socket.read_to_end(&mut bytes).expect("packets");
                bytes
            });
            send_to_tev(&address, "lvis", &film).expect("tev listens");
            tev.join().expect("all packets")
        });
        let first = u32::from_le_bytes(received[..4].try_into().expect("four bytes")) as usize;
        assert_eq!(received[4], 4, "first an image is created");
        assert_eq!(received[first + 4], 6, "then it is filled");
        let values: Vec<u8> = rgb.iter().flat_map(|v: &f32| v.to_le_bytes()).collect();
        assert!(received.ends_with(&values), "with the film's values");
    }

    #[test]
    fn nobody_there_is_an_error() {
        let film = Film::default();
        assert!(send_to_tev("127.0.0.1:1", "lvis", &film).is_err(), "nobody listens");
        assert!(send_to_tev("nowhere", "lvis", &film).is_err(), "no address");
    }
}
