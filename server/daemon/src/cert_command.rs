//! `covr cert`: a local authority and a certificate of it, for a server that no public authority knows. WebXR needs a
//! secure page; a headset trusts it once the authority's certificate is installed there.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;
use rcgen::{
    BasicConstraints, CertificateParams, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer, KeyPair,
    KeyUsagePurpose,
};
use time::{Duration, OffsetDateTime};

/// Make a local authority, if there is none yet, and a certificate for the server.
#[derive(Debug, Clone, Args)]
pub struct CertCommand {
    /// Names and addresses that people write into their browsers: lab.local, 192.168.1.5. This machine's own are added.
    #[arg(required = true)]
    pub names: Vec<String>,
    /// Where the files go; made when missing.
    #[arg(long, default_value = "covr-tls")]
    pub out: PathBuf,
    /// Days that the server's certificate is good for.
    #[arg(long, default_value_t = 397, value_parser = clap::value_parser!(u16).range(1..=825))]
    pub days: u16,
}

/// Do it; what is for standard output.
pub fn run(command: &CertCommand) -> anyhow::Result<String> {
    let out = &command.out;
    fs::create_dir_all(out).with_context(|| format!("{}", out.display()))?;
    let (authority, key) = (out.join("authority.pem"), out.join("authority.key"));
    let issuer = if key.exists() { read_authority(&key)? } else { make_authority(&authority, &key)? };

    let mut names = command.names.clone();
    names.extend(["localhost", "127.0.0.1", "::1"].map(String::from));
    let mut params = CertificateParams::new(names).context("NAMES")?;
    params.distinguished_name.push(DnType::CommonName, command.names[0].clone());
    params.use_authority_key_identifier_extension = true;
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = vec![ExtendedKeyUsagePurpose::ServerAuth];
    (params.not_before, params.not_after) = period(i64::from(command.days));
    let server_key = KeyPair::generate()?;
    let certificate = params.signed_by(&server_key, &issuer)?;
    let (server, server_key_file) = (out.join("server.pem"), out.join("server.key"));
    fs::write(&server, certificate.pem()).with_context(|| format!("{}", server.display()))?;
    write_secret(&server_key_file, &server_key.serialize_pem())?;
    Ok(format!(
        "The server's configuration:\n\n[server]\ntls_certificate = {:?}\ntls_key = {:?}\n\n\
         Install {} on every headset and browser, as an authority. Keep {} away from the network: whoever has it can \
         pretend to be any site to them.\n",
        server.display(),
        server_key_file.display(),
        authority.display(),
        key.display()
    ))
}

fn make_authority(certificate: &Path, key_file: &Path) -> anyhow::Result<Issuer<'static, KeyPair>> {
    let (params, key) = (authority()?, KeyPair::generate()?);
    let made = params.self_signed(&key)?;
    // The key last: where it is, the authority is whole.
    fs::write(certificate, made.pem()).with_context(|| format!("{}", certificate.display()))?;
    write_secret(key_file, &key.serialize_pem())?;
    Ok(Issuer::new(params, key))
}

fn read_authority(key_file: &Path) -> anyhow::Result<Issuer<'static, KeyPair>> {
    let name = || format!("{}", key_file.display());
    let key = KeyPair::from_pem(&fs::read_to_string(key_file).with_context(name)?).with_context(name)?;
    Ok(Issuer::new(authority()?, key))
}

/// Its name is another than the server's: the same for both is taken for a certificate that signs itself.
fn authority() -> anyhow::Result<CertificateParams> {
    let mut params = CertificateParams::new(Vec::new())?;
    params.distinguished_name.push(DnType::CommonName, "CoVR local authority");
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    (params.not_before, params.not_after) = period(DAYS_OF_AUTHORITY);
    Ok(params)
}

/// From yesterday on: clocks differ.
fn period(days: i64) -> (OffsetDateTime, OffsetDateTime) {
    let now = OffsetDateTime::now_utc();
    (now - Duration::days(1), now + Duration::days(days))
}

/// For its owner alone.
fn write_secret(path: &Path, text: &str) -> anyhow::Result<()> {
    // What is there may be open to others.
    let _ = fs::remove_file(path);
    let file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(path);
    file.and_then(|mut file| file.write_all(text.as_bytes())).with_context(|| format!("{}", path.display()))
}

const DAYS_OF_AUTHORITY: i64 = 3_650;
